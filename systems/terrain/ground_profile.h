#pragma once
// Ground on a foot's way, and the lift of the foot over it.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include "systems/terrain/clearance.h"

namespace mobil::inline v0_3 {

/// Heights of the ground, m, at equal parts of the way from a foot's last foothold to its next one, both included.
struct GroundProfile {
  static constexpr std::size_t asked = 15;  // between both
  float from_x_m, from_z_m, to_x_m, to_z_m;
  std::array<float, asked + 2> height_m;

  static constexpr float part(std::size_t i) { return static_cast<float>(i + 1) / static_cast<float>(asked + 1); }

  /// Returns the height of the ground at a place. A step in the ground counts as midway between two samples.
  float at(float x_m, float z_m) const;
  /// Returns the height of the straight line between the footholds.
  float straight_at(float x_m, float z_m) const;
};

/// Returns the lift with which the swing foot of one walker's step under way clears such ground. Level ground and
/// slopes need none.
FootLift lift_over(const GroundProfile& ground, const BodySize<float>& size, const StepPlan<float>& plan,
                   const GaitState<float>& state, const Footing<float>& footing);

}  // namespace mobil::inline v0_3
