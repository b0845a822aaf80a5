// SAYS: between ticks there is neither a tick nor scratch memory
#include <mobil/host_parts.h>
#include <mobil/simulation.h>

int main() {
  mobil::Simulation simulation;
  simulation.parts().each([](const mobil::Pose<mobil::Lanes<float>>&, float) {});
}
