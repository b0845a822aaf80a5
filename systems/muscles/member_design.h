#pragma once
// A single muscle of a leg as one fibre and one tendon, made from its plan; and its number.

#include <cstddef>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/activation.h>

namespace mobil::inline v0_3 {

/// Returns a member at rest in the anatomical position, with `rest_belly_m` left at 0. Pennation is the value of the
/// model that also gives the fibre's length, or the measured value for members outside the model. Force is 30 N/cm² of
/// fibres (Zajac: Muscle and tendon, Crit. Rev. Biomed. Eng. 17, 1989), which gives a leg the maximum moments of
/// people; models with 60 have the smaller muscles of old donors.
MemberDesign<float> member_design(const MemberMuscle& member, const MemberPlan& plan);

/// Returns a member's number among `member_muscles()`.
std::size_t leg_member_number(const MemberMuscle& member);

}  // namespace mobil::inline v0_3
