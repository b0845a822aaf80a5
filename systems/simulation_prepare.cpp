// What bodies of usual build share, made before it is needed.
#include <fmt/format.h>

#include "assets/anthropometry.h"
#include "systems/simulation.h"

namespace mobil {

Result<void> Simulation::prepare(const LegMuscles& choice) {
  const auto made = bellies_.bellies(*make_body({}), choice, tick_s());
  if (!made) return fail("prepare: " + made.error().message);
  return {};
}

}  // namespace mobil
