// People whose host animates them.
#include "assets/body/anthropometry.h"
#include "components/leg_frames.h"
#include "engine/rows.h"
#include "systems/kinematics/kinematics.h"
#include "systems/simulation.h"

namespace mobil {

Result<Entity> Simulation::spawn_posed(const BodyRequest& request) {
  const auto body = make_body(request);
  if (!body) return tl::unexpected(body.error());
  const BodySize<float> size{request.height_m, request.mass_kg};
  Pose<Lanes<float>> standing;
  pose_anatomical(broadcast(size), standing);
  const Entity entity = world_.create(size, first_lane(standing), Publishes<LegPost>{});
  try {
    people_.add({entity, request, true, 0, {}});
  } catch (...) {
    world_.undo_create({&entity, 1});
    throw;
  }
  return entity;
}

Status Simulation::set_pose(Entity entity, const Pose<float>& pose) {
  const PersonRecord* human = person(entity);
  if (human == nullptr) return Status::stale_entity;
  if (!human->posed) return Status::missing;
  return world_.set(entity, pose);
}

}  // namespace mobil
