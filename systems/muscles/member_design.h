#pragma once
// A single muscle of a leg as one fibre and one tendon: of its plan, and its number.

#include <cstddef>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/activation.h>

namespace mobil::inline v0_3 {

/// A member at rest in the anatomical position, but for `rest_belly_m`. Pennation is that of the model that the fibre's
/// length is of, of who is not in it the measured one; force 30 N/cm² of fibres (Zajac: Muscle and tendon, Crit. Rev.
/// Biomed. Eng. 17, 1989), with which a leg's greatest moments are those of people; models with 60 have the smaller
/// muscles of old donors.
MemberDesign<float> member_design(const MemberMuscle& member, const MemberPlan& plan);

/// Its number among `member_muscles()`.
std::size_t leg_member_number(const MemberMuscle& member);

}  // namespace mobil::inline v0_3
