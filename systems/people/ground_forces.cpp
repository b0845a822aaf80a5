#include "systems/people/ground_forces.h"

#include <algorithm>
#include <array>

#include "components/activation.h"
#include "components/sleep.h"
#include "engine/rows.h"
#include "systems/forces/forces.h"
#include "systems/kinematics/body_motion.h"
#include "systems/people/person.h"

namespace mobil {
namespace {

Status add_to_posed(World& world, Entity person) {
  if (world.has<PosedPast>(person)) return Status::ok;
  PosedPast<Lanes<float>> past{};
  GroundReaction<Lanes<float>> ground;
  JointMoments<Lanes<float>> moments;
  constexpr float no_matter_s = 1;
  press_posed(broadcast(*world.get<BodySize>(person)), broadcast(*world.get<Pose>(person)),
              broadcast(*world.get<Feet>(person)), past, no_matter_s, ground, moments);
  return world.add_parts(person,
                         std::array<PartValue, 3>{part_value(PosedPast<float>{}), part_value(first_lane(ground)),
                                                  part_value(first_lane(moments))});
}

/// A pose near the origin, where single precision is finest, in the lanes that `from` is to be taken.
void take_near(const Pose<Lanes<float>>& from, const Vec3<Lanes<float>>& origin_m, const Lanes<std::uint32_t>& taken,
               Pose<Lanes<float>>& to) {
  for (std::size_t s = 0; s < segment_count; ++s) {
    const Vec3<Lanes<float>>& p = from.position_m[s];
    const Quat<Lanes<float>>& q = from.rotation[s];
    Vec3<Lanes<float>>& at = to.position_m[s];
    Quat<Lanes<float>>& turn = to.rotation[s];
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (taken[l] == 0) continue;
      at.x[l] = p.x[l] - origin_m.x[l], at.y[l] = p.y[l] - origin_m.y[l], at.z[l] = p.z[l] - origin_m.z[l];
      turn.x[l] = q.x[l], turn.y[l] = q.y[l], turn.z[l] = q.z[l], turn.w[l] = q.w[l];
    }
  }
}

}  // namespace

void press_posed(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                 PosedPast<Lanes<float>>& past, float tick_s, GroundReaction<Lanes<float>>& ground,
                 JointMoments<Lanes<float>>& moments) {
  Lanes<std::uint32_t> all, one_known, both_known;
  Lanes<float> floor_m;
  Vec3<Lanes<float>> origin_m;
  const Vec3<Lanes<float>>& pelvis = pose.position_m[index(Segment::pelvis)];
  const Vec3<Lanes<float>>& before_pelvis = past.pose[0].position_m[index(Segment::pelvis)];
  for (std::size_t l = 0; l < lane_count; ++l) {
    all[l] = 1;
    one_known[l] = past.known[l] >= 1 ? 1 : 0;
    both_known[l] = past.known[l] >= 2 ? 1 : 0;
    floor_m[l] = std::min({feet.heel_m[Side::right].y[l], feet.toe_m[Side::right].y[l], feet.tip_m[Side::right].y[l],
                           feet.heel_m[Side::left].y[l], feet.toe_m[Side::left].y[l], feet.tip_m[Side::left].y[l]});
    const bool then = one_known[l] != 0;
    origin_m.x[l] = then ? before_pelvis.x[l] : pelvis.x[l];
    origin_m.y[l] = then ? past.floor_m[l] : floor_m[l];
    origin_m.z[l] = then ? before_pelvis.z[l] : pelvis.z[l];
  }
  Pose<Lanes<float>> before, now, after;
  take_near(pose, origin_m, all, now);
  take_near(past.pose[0], origin_m, one_known, now);
  before = after = now;
  take_near(past.pose[1], origin_m, both_known, before);
  take_near(pose, origin_m, both_known, after);

  BodyMotion<Lanes<float>> motion;
  motion_of_poses(size, before, now, after, tick_s, motion);
  posed_forces(size, motion, before, now, after, tick_s, ground, moments);
  for (const Side side : {Side::right, Side::left}) {
    Vec3<Lanes<float>>& centre = ground.centre_m[side];
    for (std::size_t l = 0; l < lane_count; ++l)
      centre.x[l] += origin_m.x[l], centre.y[l] += origin_m.y[l], centre.z[l] += origin_m.z[l];
  }
  past.pose[1] = past.pose[0];
  past.pose[0] = pose;
  past.floor_m = floor_m;
  for (std::size_t l = 0; l < lane_count; ++l) past.known[l] = std::min(past.known[l] + 1, 2U);
}

bool has_forces(const World& world, Entity person) {
  return world.has<GroundReaction>(person) || world.has<SleepsWithForces>(person);
}

Status add_forces(World& world, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  if (is_posed(world, person)) return add_to_posed(world, person);
  if (world.has<BodyMotion>(person)) return Status::ok;
  const auto size = broadcast(*world.get<BodySize>(person));
  const auto plan = broadcast(*world.get<StepPlan>(person));
  const auto state = broadcast(*world.get<GaitState>(person));
  BodyMotion<Lanes<float>> motion;
  GroundReaction<Lanes<float>> ground;
  JointMoments<Lanes<float>> moments;
  const auto footing = world.get<Footing>(person);
  const auto under = broadcast(footing.value_or(Footing<float>{}));
  walker_motion(size, plan, state, footing ? &under : nullptr, motion);
  joint_forces(size, motion, plan, state, footing ? &under : nullptr, ground, moments);
  return world.add_parts(person,
                         std::array<PartValue, 3>{part_value(first_lane(motion)), part_value(first_lane(ground)),
                                                  part_value(first_lane(moments))});
}

Status remove_forces(World& world, Entity person) {
  if (!is_person(world, person)) return Status::stale_entity;
  const bool posed = is_posed(world, person);
  if (posed ? !world.has<PosedPast>(person) : !world.has<BodyMotion>(person)) return Status::missing;
  const std::uint64_t motion = posed ? type_id<PosedPast<float>>() : type_id<BodyMotion<float>>();
  return world.remove_parts(
      person, {motion, type_id<GroundReaction<float>>(), type_id<JointMoments<float>>(), type_id<LegDesign<float>>(),
               type_id<MomentReserve<float>>(), type_id<AskedForces>()});
}

void forget_past(World& world, Entity person) {
  if (world.has<PosedPast>(person)) world.set(person, PosedPast<float>{});
}

}  // namespace mobil
