#include "systems/people/ground_forces.h"

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/sleep.h>
#include <mobil/rows.h>
#include "systems/forces/forces.h"
#include "systems/gait/body_motion.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

/// Initial force components of people of one table, sixteen to a block.
struct Beginning {
  std::vector<BodyMotion<Lanes<float>>> motion;
  std::vector<GroundReaction<Lanes<float>>> ground;
  std::vector<JointMoments<Lanes<float>>> moments;

  void work_out(const World& world, std::span<const Entity> some, bool posed, std::size_t block) {
    const auto read = [&]<template <class> class C>(C<Lanes<float>>& lanes) {
      for (std::size_t l = 0; l < lane_count; ++l) put_row(*world.get<C>(some[l < some.size() ? l : 0]), lanes, l);
    };
    BodySize<Lanes<float>> size;
    read(size);
    if (posed) {
      struct Posed {
        PoseHistory<Lanes<float>> past{};
        Pose<Lanes<float>> pose;
        Feet<Lanes<float>> feet;
      };
      const auto at = std::make_unique<Posed>();  // too large for small stacks
      read(at->pose);
      read(at->feet);
      constexpr float no_matter_s = 1;
      return press_posed(size, at->pose, at->feet, at->past, no_matter_s, ground[block], moments[block]);
    }
    struct Walking {
      StepPlan<Lanes<float>> plan;
      GaitState<Lanes<float>> state;
      Footing<Lanes<float>> footing;
    };
    const auto at = std::make_unique<Walking>();
    read(at->plan);
    read(at->state);
    const Footing<Lanes<float>>* const under = world.has<Footing>(some.front()) ? &at->footing : nullptr;
    if (under != nullptr) read(at->footing);
    walker_motion(size, at->plan, at->state, under, motion[block]);
    joint_forces(size, motion[block], at->plan, at->state, under, ground[block], moments[block]);
  }
};

void begin_forces(World& world, const Jobs& jobs, std::span<const Entity> people) {
  const bool posed = is_posed(world, people.front());
  const std::size_t blocks = (people.size() + lane_count - 1) / lane_count;
  Beginning at;
  at.motion.resize(posed ? 0 : blocks);
  at.ground.resize(blocks);
  at.moments.resize(blocks);
  in_parallel(jobs, blocks, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      at.work_out(world, people.subspan(b * lane_count, std::min(lane_count, people.size() - b * lane_count)), posed,
                  b);
  });
  const std::array<PartValue, 3> parts = {{posed ? PartValue{component_id<PoseHistory>(), nullptr}
                                                 : PartValue{component_id<BodyMotion>(), at.motion.data()},
                                           {component_id<GroundReaction>(), at.ground.data()},
                                           {component_id<JointMoments>(), at.moments.data()}}};
  world.change_archetype(people, parts, {}, jobs);
}

/// Returns the ids, sorted, of the force components and of the components that depend on them.
std::span<const std::uint64_t> force_part_ids() {
  static const auto ids = [] {
    std::array all = {type_id<PoseHistory<float>>(),     type_id<BodyMotion<float>>(), type_id<GroundReaction<float>>(),
                      type_id<JointMoments<float>>(),    type_id<LegDesign<float>>(),  type_id<MomentReserve<float>>(),
                      type_id<SharingProgress<float>>(), type_id<AskedForces>()};
    std::ranges::sort(all);
    return all;
  }();
  return ids;
}

/// Copies `from` minus `origin_m`, near the origin, where single precision is finest, in lanes with `taken` set.
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
                 PoseHistory<Lanes<float>>& past, float tick_s, GroundReaction<Lanes<float>>& ground,
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

Status set_forces(World& world, const Jobs& jobs, std::span<const Entity> people, bool on) {
  std::vector<Entity> changes;
  for (const Entity person : people) {
    if (!is_person(world, person)) return Status::stale_entity;
    if (has_forces(world, person) != on) changes.push_back(person);
  }
  World::Transaction transaction(world, jobs);
  group_by_table(world, changes, [&](std::span<const Entity> together) {
    if (on)
      begin_forces(world, jobs, together);
    else
      world.change_archetype(together, {}, force_part_ids(), jobs);
  });
  transaction.commit();
  return Status::ok;
}

void clear_pose_history(World& world, Entity person) {
  if (world.has<PoseHistory>(person)) world.set(person, PoseHistory<float>{});
}

}  // namespace mobil::inline v0_3
