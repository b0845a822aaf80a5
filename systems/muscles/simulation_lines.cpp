#include "systems/muscles/simulation_lines.h"

#include <cstddef>

#include "engine/world.h"
#include "systems/kinematics/kinematics.h"
#include "systems/lines/frame_motion.h"
#include "systems/lines/line_motion.h"
#include "systems/lines/line_of_action.h"
#include "systems/people/simulation_rows.h"

namespace mobil {

namespace {

LegFrames<Lanes<float>> leg_of(const Pose<float>& pose, Side side) {
  LegFrames<Lanes<float>> leg;
  for (std::size_t lane = 0; lane < lane_count; ++lane) gather_leg(pose, side, leg, lane);
  return leg;
}

}  // namespace

template <template <class> class End>
FirstLine<End> first_line(const MuscleLines& lines, const LegScale<float>& scale, const LineOfAction<float>& rest,
                          const Pose<float>& pose, Side side) {
  auto line = broadcast(rest);
  End<Lanes<float>> end{};
  lines_of_action(lines, broadcast(scale), leg_of(pose, side), line, end);
  return {first_lane(line), first_lane(end)};
}

template FirstLine<EndDisplacement> first_line(const MuscleLines&, const LegScale<float>&, const LineOfAction<float>&,
                                               const Pose<float>&, Side);
template FirstLine<EndForce> first_line(const MuscleLines&, const LegScale<float>&, const LineOfAction<float>&,
                                        const Pose<float>&, Side);

LineMotion<float> first_motion(const MuscleLines& lines, const LegScale<float>& scale, const Pose<float>& pose,
                               Side side, const LineOfAction<float>& line, float tick_s) {
  LineMotion<Lanes<float>> motion{};
  line_motion(lines, broadcast(scale), leg_of(pose, side), broadcast(line), motion, tick_s);
  return first_lane(motion);
}

void look_back(const World& world, Entity human, std::uint32_t tick, float tick_s, RecentPoses& recent) {
  if (recent.human == human && recent.tick == tick) return;
  recent.human = {};  // nobody's, should memory run out
  recent.poses.clear();
  recent.poses.reserve(4);
  recent.human = human;
  recent.tick = tick;
  const auto state = world.get<GaitState>(human);
  if (!state) {
    recent.poses.push_back(*world.get<Pose>(human));
    return;
  }
  const auto sizes = broadcast(*world.get<BodySize>(human));
  const auto plan = *world.get<StepPlan>(human);
  for (const float ticks : {3.0F, 2.0F, 1.0F, 0.0F}) {
    const auto then = earlier(*state, plan, ticks * tick_s);
    if (!then) continue;
    Pose<Lanes<float>> pose;
    JointAngles<Lanes<float>> angles;
    Feet<Lanes<float>> feet;
    pose_skeleton(sizes, broadcast(plan), broadcast(*then), pose, angles, feet);
    recent.poses.push_back(first_lane(pose));
  }
}

Inertia recent_inertia(const RecentPoses& recent, const MuscleLines& lines, const LegScale<float>& scale, Side side,
                       float tick_s) {
  FrameHistory<Lanes<float>> history{};
  FrameLoad<Lanes<float>> load{};
  for (const Pose<float>& pose : recent.poses) {
    const auto line = first_line<EndDisplacement>(lines, scale, {}, pose, side).line;
    frame_motion(broadcast(line), history, load, tick_s);
  }
  return {first_lane(history), first_lane(load)};
}

}  // namespace mobil
