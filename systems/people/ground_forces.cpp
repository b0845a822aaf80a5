#include "systems/people/ground_forces.h"

#include <array>

#include "components/forces.h"
#include "engine/rows.h"
#include "systems/forces/forces.h"
#include "systems/kinematics/kinematics.h"
#include "systems/people/person.h"
#include "systems/people/walker_past.h"

namespace mobil {
namespace {

/// The motion of a person up to now, as two ticks of the system of forces would have recorded it.
MotionHistory<float> recent_motion(const BodySize<float>& size, const StepPlan<float>& plan,
                                   const GaitState<float>& state, float tick_s) {
  MotionHistory<Lanes<float>> history{};
  const auto sizes = broadcast(size);
  const auto plans = broadcast(plan);
  for (const float ago : {tick_s, 0.0F}) {
    GaitState<float> at_start = state;
    at_start.time_s = 0;
    const auto states = broadcast(earlier(state, plan, ago).value_or(at_start));
    Pose<Lanes<float>> pose;
    JointAngles<Lanes<float>> angles;
    Feet<Lanes<float>> feet;
    CentreOfMass<Lanes<float>> centre;
    GroundReaction<Lanes<float>> ground;
    JointMoments<Lanes<float>> moments;
    pose_skeleton(sizes, plans, states, pose, angles, feet);
    centre_of_mass(sizes, pose, centre);
    joint_forces(sizes, pose, feet, centre, plans, states, history, ground, moments, tick_s);
  }
  return first_lane(history);
}

}  // namespace

Status add_forces(World& world, Entity person, float tick_s) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (is_posed(world, person)) return Status::missing;
  if (world.has<MotionHistory>(person)) return Status::ok;
  const MotionHistory<float> motion =
      recent_motion(*world.get<BodySize>(person), *world.get<StepPlan>(person), *world.get<GaitState>(person), tick_s);
  return world.add_parts(person,
                         std::array<PartValue, 3>{
                             part_value(motion), {component_part<GroundReaction>()}, {component_part<JointMoments>()}});
}

Status remove_forces(World& world, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (!world.has<MotionHistory>(person)) return Status::ok;
  return world.remove_parts(
      person, {type_id<MotionHistory<float>>(), type_id<GroundReaction<float>>(), type_id<JointMoments<float>>()});
}

}  // namespace mobil
