// Muscles that change their method under way.
#include "systems/simulation.h"

namespace mobil {

Result<void> Simulation::set_method(Entity, Muscle, const MuscleMethod&) {
  return fail("set_method: not there yet");
}

MuscleMethod Simulation::method(Entity entity, Muscle muscle) const {
  const Human* owner = human(entity);
  if (owner == nullptr) return {Method::none};
  for (const HumanMuscle& own : owner->muscles) {
    if (own.plan.muscle == muscle) return own.method;
  }
  return {Method::none};
}

}  // namespace mobil
