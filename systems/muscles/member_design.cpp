#include "systems/muscles/member_design.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/exact_math.h"

namespace mobil::inline v0_3 {

MemberDesign<float> member_design(const MemberMuscle& member, const MemberPlan& plan) {
  constexpr double specific_force_pa = 30e4;
  const double angle = member.model_path_m > 0 ? member.model_pennation_deg : member.pennation_deg;
  const double height = plan.fibre_m * exact::sin(angle * std::numbers::pi / 180);
  return {static_cast<float>(plan.fibre_m), static_cast<float>(plan.tendon_m), static_cast<float>(height), 0,
          static_cast<float>(specific_force_pa * plan.volume_m3 / plan.fibre_m)};
}

std::size_t leg_member_number(const MemberMuscle& member) {
  const auto all = member_muscles();
  return static_cast<std::size_t>(std::ranges::find(all, member.name, &MemberMuscle::name) - all.begin());
}

}  // namespace mobil::inline v0_3
