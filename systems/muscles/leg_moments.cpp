#include "systems/muscles/leg_moments.h"

#include <array>
#include <cmath>
#include <vector>

#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/components/activation.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/rows.h>
#include <mobil/schedule.h>
#include "engine/snapshot.h"
#include "systems/activation/moment_sharing.h"
#include "systems/lines/leg_arms.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/member_design.h"
#include "systems/people/ground_forces.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_leg_moments {

/// Returns the lines of a leg, in the order of member_muscles().
const std::vector<MuscleLines>& leg_lines() {
  static const std::vector<MuscleLines> all = [] {
    std::vector<MuscleLines> lines;
    for (const MemberMuscle& line : member_muscles()) lines.push_back(make_single_line(line));
    return lines;
  }();
  return all;
}

/// Returns the direction ahead of both thighs, horizontal, as JointMoments defines it. The left leg is mirrored.
Vec3<Lanes<float>> facing_of(const LegFrames<Lanes<float>> (&leg)[2]) {
  Vec3<Lanes<float>> ahead{};
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    float left_x = 0, left_z = 0;  // of the thighs' axes to the left
    for (const Side side : {Side::right, Side::left}) {
      const Quat<Lanes<float>>& q = leg[side].thigh;
      const float x = q.x[lane], y = q.y[lane], z = q.z[lane], w = q.w[lane];
      left_x += 1 - 2 * (y * y + z * z);
      left_z += (side == Side::left ? -2 : 2) * (x * z - y * w);
    }
    const float size = std::sqrt(left_x * left_x + left_z * left_z), over = size > 1e-6F ? 1 / size : 0;
    ahead.x[lane] = -left_z * over;
    ahead.z[lane] = left_x * over;
  }
  return ahead;
}

void share(const LegDesign<Lanes<float>>& design, const Pose<Lanes<float>>& pose,
           const JointMoments<Lanes<float>>& moments, MomentReserve<Lanes<float>>& reserve,
           SharingProgress<Lanes<float>>& progress, Published<AskedForces> asked) {
  LegFrames<Lanes<float>> leg[2];
  for (const Side side : {Side::right, Side::left})
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      gather_leg(reinterpret_cast<const float*>(&pose) + lane, side, leg[side], lane);
  Vec3<Lanes<float>> ahead = facing_of(leg);
  for (const Side side : {Side::right, Side::left}) {
    if (side == Side::left)
      for (float& x : ahead.x.lane) x = -x;
    std::array<Lanes<float>, leg_member_count> path, of_most;
    std::array<LegMoments<Lanes<float>>, leg_member_count> arm;
    SharedLeg shared{path.data(), arm.data(), {}, design.scale.across};
    leg_arms(leg_lines(), design.scale, leg[side], ahead, path.data(), arm.data(), shared.flexion_rad);
    share_moments(design, shared,
                  {moments.hip_nm[side], moments.hip_abduction_nm[side], moments.hip_rotation_nm[side],
                   moments.knee_nm[side], moments.ankle_nm[side]},
                  progress.price[side], progress.of_most[side], of_most.data(), reserve.left_nm[side],
                  reserve.at_most[side]);
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      for (std::size_t i = 0; i < leg_member_count; ++i) asked.row[lane].leg[side].of_most[i] = of_most[i][lane];
  }
}

/// Checks that a row has all of these components or none, and has moments with them.
Result<void> check_key(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool design = has(type_id<LegDesign<float>>()), reserve = has(type_id<MomentReserve<float>>());
  const bool progress = has(type_id<SharingProgress<float>>());
  const bool asked = has(type_id<AskedForces>()), moments = has(type_id<JointMoments<float>>());
  if (design == reserve && reserve == asked && asked == progress && (!design || moments)) return {};
  return damaged("shared moments of a person");
}

}  // namespace of_leg_moments
}  // namespace

Module leg_moments_module() {
  of_leg_moments::leg_lines();  // made here, not during a tick
  return {.name = "leg moments",
          .parts = {component_id<LegDesign>(), component_id<MomentReserve>(), component_id<SharingProgress>(),
                    component_id(Publishes<AskedForces>{})},
          .systems = [](ScheduleBuilder& systems) { systems.add("leg moments", &of_leg_moments::share); },
          .check_key = &of_leg_moments::check_key};
}

Result<void> check_leg_moments(const World& world, Entity person, const LegMuscles& choice) {
  if (!follows_moments(choice) || has_forces(world, person)) return {};
  return fail("activation by moments needs the moments at the joints; enable Feature::forces first", Status::missing);
}

void set_leg_moments(World& world, Entity person, const Body& body, const LegMuscles& choice) {
  if (!follows_moments(choice)) return forget_leg_moments(world, person);
  if (world.has<LegDesign>(person)) return;
  LegDesign<float> design{};
  std::size_t i = 0;
  const LegScale<double> scale = leg_scale(body);
  design.scale = {static_cast<float>(scale.thigh), static_cast<float>(scale.shank), static_cast<float>(scale.across)};
  const LegFrames<double> standing = anatomical_leg(body);
  for (const MemberMuscle& line : member_muscles())
    design.member[i++] = member_design(line, plan_member(body, line, member_length(line, scale, standing)));
  // A change of archetype, which a World::Transaction can undo.
  world.change_archetype({&person, 1},
                         std::array<PartValue, 4>{PartValue{component_id<LegDesign>(), nullptr},
                                                  PartValue{component_id<MomentReserve>(), nullptr},
                                                  PartValue{component_id<SharingProgress>(), nullptr},
                                                  part_value(Publishes<AskedForces>{})},
                         {});
  world.set(person, design);
}

void forget_leg_moments(World& world, Entity person) {
  if (world.has<LegDesign>(person))
    world.remove_parts(person, {type_id<LegDesign<float>>(), type_id<MomentReserve<float>>(),
                                type_id<SharingProgress<float>>(), type_id<AskedForces>()});
}

}  // namespace mobil::inline v0_3
