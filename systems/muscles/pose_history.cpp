#include "systems/muscles/pose_history.h"

#include <cstddef>

#include <mobil/engine/world.h>
#include <mobil/rows.h>
#include "systems/gait/kinematics.h"
#include "systems/lines/line_of_action.h"
#include "systems/people/walker_history.h"

namespace mobil::inline v0_3 {

LegFrames<Lanes<float>> leg_of(const Pose<float>& pose, Side side) {
  LegFrames<Lanes<float>> leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) gather_leg(pose, side, leg, lane);
  return leg;
}

FirstLine first_line(const MuscleLines& lines, const LegScale<float>& scale, FarEnd far_end,
                     const LineOfAction<float>& rest, const Pose<float>& pose, Side side) {
  auto line = broadcast(rest);
  EndDrive<Lanes<float>> end{};
  lines_of_action(lines, broadcast(scale), leg_of(pose, side), far_end, line, end);
  return {first_lane(line), first_lane(end)};
}

/// Returns the footing of the previous step; its first foothold is unknown.
Footing<float> a_step_before(Footing<float> footing) {
  constexpr auto leaving = index(FootholdOf::leaving);
  constexpr auto stance = index(FootholdOf::stance);
  constexpr auto landing = index(FootholdOf::landing);
  for (auto* values : by_foothold(footing)) {
    (*values)[landing] = (*values)[stance];
    (*values)[stance] = (*values)[leaving];
  }
  footing.lift_early_m = footing.lift_late_m = 0;
  return footing;
}

void look_back(const World& world, Entity person, std::uint32_t tick, float tick_s, RecentPoses& recent) {
  if (recent.person == person && recent.tick == tick) return;
  recent.person = {};  // invalid if reserve throws
  recent.poses.clear();
  recent.poses.reserve(4);
  recent.person = person;
  recent.tick = tick;
  const auto state = world.get<GaitState>(person);
  if (!state) {
    recent.poses.push_back(*world.get<Pose>(person));
    return;
  }
  const auto sizes = broadcast(*world.get<BodySize>(person));
  const auto plan = *world.get<StepPlan>(person);
  const auto footing = world.get<Footing>(person);
  const Footing<float> now = footing.value_or(Footing<float>{});
  for (const float ticks : {3.0F, 2.0F, 1.0F, 0.0F}) {
    const auto then = earlier(*state, plan, ticks * tick_s);
    if (!then) continue;
    Pose<Lanes<float>> pose;
    JointAngles<Lanes<float>> angles;
    Feet<Lanes<float>> feet;
    const auto under = broadcast(then->stance_side == state->stance_side ? now : a_step_before(now));
    pose_skeleton(sizes, broadcast(plan), broadcast(*then), footing ? &under : nullptr, pose, angles, feet);
    recent.poses.push_back(first_lane(pose));
  }
}

}  // namespace mobil::inline v0_3
