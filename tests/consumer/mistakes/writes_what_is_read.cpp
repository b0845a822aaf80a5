// SAYS: this world is only read
#include <mobil/each.h>
#include <mobil/host_parts.h>
#include <mobil/simulation.h>

int main() {
  const mobil::Simulation simulation;
  simulation.parts().each(
      [](const mobil::Rows&, mobil::Pose<mobil::Lanes<float>>& pose) { pose.position_m[0].x[0] = 0; });
}
