#include "systems/muscles/leg_moments.h"

#include <array>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/rows.h>
#include <mobil/schedule.h>
#include "engine/snapshot.h"
#include "systems/activation/moment_sharing.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "systems/muscles/member_design.h"
#include "systems/people/ground_forces.h"

namespace mobil::inline v0_3 {
namespace {
namespace of_leg_moments {

/// Returns the lines of the single muscles, by number.
const std::vector<MuscleLines>& single_lines() {
  static const std::vector<MuscleLines> all = [] {
    std::vector<MuscleLines> lines;
    for (const MemberMuscle& member : member_muscles()) lines.push_back(make_muscle_lines(*find_muscle(member.name)));
    return lines;
  }();
  return all;
}

void find_arms(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& leg,
               Lanes<float>& path_m, LegMoments<Lanes<float>>& arm_m) {
  LineOfAction<Lanes<float>> line{};
  EndDrive<Lanes<float>> end{};
  LineMotion<Lanes<float>> motion{};
  constexpr float no_matter_s = 1;
  lines_of_action(lines, scale, leg, FarEnd::held, line, end, &path_m);
  line_motion(lines, scale, leg, line, motion, no_matter_s);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    arm_m.hip[lane] = -motion.hip_flexion_arm_m[lane];
    arm_m.knee[lane] = -motion.knee_flexion_arm_m[lane];
    arm_m.ankle[lane] = -motion.ankle_dorsiflexion_arm_m[lane];
  }
}

void share(const LegDesign<Lanes<float>>& design, const Pose<Lanes<float>>& pose,
           const JointMoments<Lanes<float>>& moments, MomentReserve<Lanes<float>>& reserve,
           Published<AskedForces> asked) {
  const std::vector<MuscleLines>& lines = single_lines();
  for (const Side side : {Side::right, Side::left}) {
    LegFrames<Lanes<float>> leg;
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      gather_leg(reinterpret_cast<const float*>(&pose) + lane, side, leg, lane);
    std::array<Lanes<float>, leg_member_count> path, of_most;
    std::array<LegMoments<Lanes<float>>, leg_member_count> arm;
    for (std::size_t i = 0; i < leg_member_count; ++i) find_arms(lines[i], design.scale, leg, path[i], arm[i]);
    LegMoments<Lanes<float>> left;
    share_moments(design, path.data(), arm.data(),
                  {moments.hip_nm[side], moments.knee_nm[side], moments.ankle_nm[side]}, of_most.data(), left,
                  reserve.at_most[side]);
    reserve.hip_nm[side] = left.hip;
    reserve.knee_nm[side] = left.knee;
    reserve.ankle_nm[side] = left.ankle;
    for (std::size_t lane = 0; lane < lane_count; ++lane)
      for (std::size_t i = 0; i < leg_member_count; ++i) asked.row[lane].leg[side].of_most[i] = of_most[i][lane];
  }
}

/// Checks that a row has all of these components or none, and has moments with them.
Result<void> check_key(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool design = has(type_id<LegDesign<float>>()), reserve = has(type_id<MomentReserve<float>>());
  const bool asked = has(type_id<AskedForces>()), moments = has(type_id<JointMoments<float>>());
  if (design == reserve && reserve == asked && (!design || moments)) return {};
  return damaged("shared moments of a person");
}

}  // namespace of_leg_moments
}  // namespace

Module leg_moments_module() {
  of_leg_moments::single_lines();  // made here, not during a tick
  return {.name = "leg moments",
          .parts = {component_id<LegDesign>(), component_id<MomentReserve>(), component_id(Publishes<AskedForces>{})},
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
  for (const MemberMuscle& member : member_muscles()) {
    const MusclePlan plan = *make_muscle_plan(body, *find_muscle(member.name));
    design.member[i++] = member_design(member, plan.member[0]);
    design.scale = plan.leg_scale;
  }
  // A change of archetype, which a World::Transaction can undo.
  world.change_archetype(
      {&person, 1},
      std::array<PartValue, 3>{PartValue{component_id<LegDesign>(), nullptr},
                               PartValue{component_id<MomentReserve>(), nullptr}, part_value(Publishes<AskedForces>{})},
      {});
  world.set(person, design);
}

void forget_leg_moments(World& world, Entity person) {
  if (world.has<LegDesign>(person))
    world.remove_parts(person, {type_id<LegDesign<float>>(), type_id<MomentReserve<float>>(), type_id<AskedForces>()});
}

}  // namespace mobil::inline v0_3
