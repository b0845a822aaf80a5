// SAYS: an Entity is two UInt32<F>, index and generation
#include <mobil/host_parts.h>
#include <mobil/simulation.h>

template <class F>
struct Target {
  mobil::Entity who;
  F weight;
};

int main() {
  mobil::Simulation simulation;
  simulation.parts().add(*simulation.spawn({}), Target<float>{});
}
