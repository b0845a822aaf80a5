#pragma once
// From the motion of the skeleton to the reaction of the ground and the moments at the joints (paper, section 4.3).

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// Ground reaction of each foot and sagittal moments at hip, knee and ankle, by free-body diagrams from the foot up, at
/// the instant that `motion` is of.
///
/// TOTAL. mass · (acceleration of the centre of mass + g), the centre being that of all 48 segments.
/// CENTRE OF PRESSURE. Where the moment of the total is that of the motion, its turning included: nothing is left
/// unbalanced in pitch and roll, as far as soles reach. Each foot is pressed where the fitted walk has it
/// (assets/gait), and both centres are moved by what lacks, along the part of the sole that bears and to its sides;
/// what then is left goes to the shares, where both feet bear. SPLIT. Where nothing is left, the support foot's share
/// in double support is the fitted one. Fore-aft and sideways each foot's force leans toward one point over the body;
/// what the feet's forces then lack to the total is shared like the vertical force, so that their sum is exactly the
/// total; in double support the feet push apart as the fitted walk has it. MOMENTS. About the horizontal axis through
/// the joint, across the mean direction that the two thighs face. Thigh with kneecap, shank, and foot with toes have
/// Winter's radii of gyration; thigh and shank are slender rods, and so is the foot from ankle to ball. `footing`: the
/// ground under the feet, on which the centres then lie; null where it is level.
void joint_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                  const Footing<Lanes<float>>* footing, GroundReaction<Lanes<float>>& reaction,
                  JointMoments<Lanes<float>>& moments);

/// The same of people whose host animates them, from three poses `apart_s` seconds apart: at the instant of the middle
/// one, which `motion` is of, in the same frame; its floor, y = 0, is the ground. The total and the moments follow as
/// above. There is no plan, so contact is taken from the poses: a foot bears as far as heel, ball or toes are near the
/// ground (none 3 cm over it) and at rest (none faster than 1.2 m/s), within that as the motion balances best; the
/// ground never pulls.
void posed_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after,
                  float apart_s, GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments);

}  // namespace mobil::inline v0_3
