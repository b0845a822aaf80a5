// People whose host animates them.
#include "systems/simulation.h"

namespace mobil {

Result<Entity> Simulation::spawn_posed(const BodyRequest&) {
  return fail("spawn_posed: not there yet");
}

Status Simulation::set_pose(Entity, const Pose<float>&) {
  return Status::stale_entity;
}

}  // namespace mobil
