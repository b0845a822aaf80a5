#pragma once
// Sizes of a person's muscle, as stored in its rows.

#include <array>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>

namespace mobil::inline v0_3 {

struct MuscleSize {
  BellyScale<float> scale{};
  LegScale<float> leg_scale{};
  float rest_length_m = 0;
  std::array<MemberPlan, max_row_members> member{};
};
inline MuscleSize size_of(const MusclePlan& plan) {
  return {plan.scale, plan.leg_scale, static_cast<float>(plan.rest_length_m), plan.member};
}

}  // namespace mobil::inline v0_3
