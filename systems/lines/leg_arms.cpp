#include "systems/lines/leg_arms.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "systems/lines/moment_arms-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

void arms_of_leg(std::span<const MuscleLines> lines, const LegScale<Lanes<float>>& scale,
                 const LegFrames<Lanes<float>>& legs, const Vec3<Lanes<float>>& facing, Lanes<float>* path_m,
                 LegMoments<Lanes<float>>* arm_m, LegFlexion<Lanes<float>>& flexion_rad) {
  const Leg leg = load_leg(lines.front(), scale, legs);
  const Joints joints = find_joints(leg, lines.front().rolling);
  const WideVec ahead = load(facing);
  store(-knee_flexion(leg.rotation[0], leg.rotation[1]), flexion_rad.hip);
  store(leg.flexion, flexion_rad.knee);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const MuscleLines::Member& line = lines[i].members.front();
    const WideVec end = path_end(leg, line);
    Wide along = wide(0.0F);
    along_path(leg, line, end, [&along](const WideVec& from, const WideVec& to, LegBone, const WideMask*) HWY_ATTR {
      along = along + length(to - from);
    });
    store(along, path_m[i]);
    const Arms arms = arms_of<true>(leg, joints, line, end);
    const WideVec& hip = arms.about_hip;
    store(hip.x * ahead.z - hip.z * ahead.x, arm_m[i].hip);  // about the axis to the left
    store(-(hip.x * ahead.x) - hip.z * ahead.z, arm_m[i].hip_abduction);
    store(hip.y, arm_m[i].hip_rotation);
    store(-arms.of[leg_knee], arm_m[i].knee);
    store(-arms.of[leg_ankle], arm_m[i].ankle);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(arms_of_leg);
}  // namespace

void leg_arms(std::span<const MuscleLines> lines, const LegScale<Lanes<float>>& scale,
              const LegFrames<Lanes<float>>& legs, const Vec3<Lanes<float>>& facing, Lanes<float>* path_m,
              LegMoments<Lanes<float>>* arm_m, LegFlexion<Lanes<float>>& flexion_rad) {
  HWY_DYNAMIC_DISPATCH(arms_of_leg)(lines, scale, legs, facing, path_m, arm_m, flexion_rad);
}

}  // namespace mobil::inline v0_3
#endif
