// SAYS: this world is only read
#include <mobil/each.h>
#include <mobil/simulation.h>

int main() {
  const mobil::Simulation simulation;
  mobil::each(simulation.world(),
              [](const mobil::Rows&, mobil::Pose<mobil::Lanes<float>>& pose) { pose.position_m[0].x[0] = 0; });
}
