// SAYS: a component is a template over its number type
#include <mobil/host_parts.h>
#include <mobil/simulation.h>

struct Fatigue {
  float level;
};

int main() {
  mobil::Simulation simulation;
  simulation.parts().add(*simulation.spawn({}), Fatigue{1});
}
