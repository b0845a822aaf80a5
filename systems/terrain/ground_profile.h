#pragma once
// The ground on a foot's way, and how high the foot is lifted over it.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include "systems/terrain/clearance.h"

namespace mobil::inline v0_3 {

/// Heights of the ground, m, at equal parts of the way from a foot's last foothold to its next one, both included.
struct GroundProfile {
  static constexpr std::size_t asked = 15;  // between both
  float from_x_m, from_z_m, to_x_m, to_z_m;
  std::array<float, asked + 2> height_m;

  static constexpr float part(std::size_t i) { return static_cast<float>(i + 1) / static_cast<float>(asked + 1); }

  /// A step in the ground is taken to be midway between two places.
  float at(float x_m, float z_m) const;
  /// Straight from one foothold to the other.
  float straight_at(float x_m, float z_m) const;
};

/// The lift with which the foot in the air passes over such ground, of one walker's step under way. Level ground and
/// slopes it keeps clear of by itself.
FootLift lift_over(const GroundProfile& ground, const BodySize<float>& size, const StepPlan<float>& plan,
                   const GaitState<float>& state, const Footing<float>& footing);

}  // namespace mobil::inline v0_3
