#include "systems/terrain/foot_path.h"

#include <algorithm>

#include <mobil/components/pose.h>
#include <mobil/rows.h>
#include "systems/gait/kinematics.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns the phase of a step at a part of its time (as step_phase in assets/gait/step_curves-inl.h).
float phase_at(const StepPlan<float>& plan, float u) {
  const float from = plan.phase_rate_from, r = 1 - from, s = plan.phase_rate_to - from;
  return u * (u * u * (u * (u * (6 * r - 3 * s) + (7 * s - 15 * r)) + (10 * r - 4 * s)) + from);
}

/// Parts of the swing between which a foot can be lifted. Outside them it has hardly left the ground, or is landing.
constexpr float first_part = 0.15F, last_part = 0.85F;

}  // namespace

FootPath foot_path(const BodySize<float>& size, const StepPlan<float>& plan, const GaitState<float>& state,
                   const Footing<float>& footing) {
  FootPath path;
  auto states = broadcast(state);
  const auto under = broadcast(footing);
  const float swing_s = plan.duration_s - plan.double_support_s;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const float part = (static_cast<float>(l) + 0.5F) / lane_count;
    states.time_s[l] = plan.double_support_s + part * swing_s;
    const float in_air = (phase_at(plan, states.time_s[l] / plan.duration_s) - plan.double_support) /
                         std::max(plan.landing - plan.double_support, 1e-3F);
    path.at[l].part = std::clamp(in_air, first_part, last_part);
  }
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  pose_skeleton(broadcast(size), broadcast(plan), states, &under, pose, angles, feet);
  const std::size_t side = (state.stance_side ^ 1U) & 1U;
  for (std::size_t l = 0; l < lane_count; ++l) {
    std::size_t i = 0;
    for (const auto* points : {&feet.heel_m, &feet.toe_m, &feet.tip_m}) {
      const Vec3<Lanes<float>>& p = (*points)[side];
      path.at[l].point_m[i++] = {p.x[l], p.y[l], p.z[l]};
    }
  }
  return path;
}

}  // namespace mobil::inline v0_3
