// SAYS: name the component without its number type
#include <mobil/simulation.h>

int main() {
  const mobil::Simulation simulation;
  const auto pose = simulation.get<mobil::Pose<float>>({});
}
