#include "systems/people/ground_forces.h"

#include <array>

#include "components/forces.h"
#include "engine/rows.h"
#include "systems/forces/forces.h"
#include "systems/kinematics/body_motion.h"
#include "systems/people/person.h"

namespace mobil {

Status add_forces(World& world, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (is_posed(world, person)) return Status::missing;
  if (world.has<BodyMotion>(person)) return Status::ok;
  const auto size = broadcast(*world.get<BodySize>(person));
  const auto plan = broadcast(*world.get<StepPlan>(person));
  const auto state = broadcast(*world.get<GaitState>(person));
  BodyMotion<Lanes<float>> motion;
  GroundReaction<Lanes<float>> ground;
  JointMoments<Lanes<float>> moments;
  walker_motion(size, plan, state, motion);
  joint_forces(size, motion, plan, state, ground, moments);
  return world.add_parts(person,
                         std::array<PartValue, 3>{part_value(first_lane(motion)), part_value(first_lane(ground)),
                                                  part_value(first_lane(moments))});
}

Status remove_forces(World& world, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (!world.has<BodyMotion>(person)) return Status::missing;
  return world.remove_parts(
      person, {type_id<BodyMotion<float>>(), type_id<GroundReaction<float>>(), type_id<JointMoments<float>>()});
}

}  // namespace mobil
