#include "systems/lines/line_motion.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "systems/lines/moment_arms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
void move_lines(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s) {
  const Wide before = load(motion.length_m), now = load(line.length_m), zero = wide(0.0F);
  store(select(before <= zero, zero, (now - before) / wide(tick_s)), motion.speed_m_s);
  store(now, motion.length_m);

  const Leg leg = load_leg(lines, scale, legs);
  const Joints joints = find_joints(leg, lines.rolling);
  Wide mean[leg_joints] = {zero, zero, zero};
  for (const MuscleLines::Member& member : lines.members) {
    const Arms arms = arms_of<false>(leg, joints, member, path_end(leg, member));
    for (std::size_t j = 0; j < leg_joints; ++j) mean[j] = fma(wide(member.weight), arms.of[j], mean[j]);
  }
  store(mean[leg_hip], motion.hip_flexion_arm_m);
  store(mean[leg_knee], motion.knee_flexion_arm_m);
  store(mean[leg_ankle], motion.ankle_dorsiflexion_arm_m);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(move_lines);
}  // namespace

void line_motion(const MuscleLines& lines, const LegScale<Lanes<float>>& scale, const LegFrames<Lanes<float>>& legs,
                 const LineOfAction<Lanes<float>>& line, LineMotion<Lanes<float>>& motion, float tick_s) {
  HWY_DYNAMIC_DISPATCH(move_lines)(lines, scale, legs, line, motion, tick_s);
}

}  // namespace mobil::inline v0_3
#endif
