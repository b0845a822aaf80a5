#pragma once
// Computes ground reaction forces and joint moments from the motion of the skeleton (paper, section 4.3).

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/forces.h>

namespace mobil::inline v0_3 {

/// Computes the ground reaction of each foot and the sagittal moments at hip, knee and ankle, by free-body diagrams
/// from the foot up, at the instant that `motion` describes.
///
/// TOTAL. The force is mass · (acceleration of the centre of mass + g), for the centre of mass of all 48 segments.
/// CENTRE OF PRESSURE. The total acts where its moment equals that of the motion, including rotation. As far as the
/// soles reach, pitch and roll are balanced. Each foot starts at the centre of pressure of the fitted walk
/// (assets/gait). Both centres are then moved by the missing distance, along the bearing part of the sole and sideways.
/// In double support the shares of the feet balance the remainder. SPLIT. Without a remainder, the support foot's share
/// in double support is the fitted one. Each foot's force leans fore-aft and sideways toward one point above the body.
/// The horizontal force still missing is shared like the vertical force, so the sum is exactly the total. In double
/// support the feet push apart as in the fitted walk. FREE MOMENT. The moment about the vertical that the forces lack is
/// shared in proportion to the feet's loads, up to 0.05 N m/N. MOMENTS. They are about the horizontal axis through the
/// joint, perpendicular to the mean facing of the two thighs. The hip's frontal and transverse moments are about that
/// facing and the vertical. Thigh with kneecap, shank, and foot with toes have Winter's radii of gyration. Thigh, shank,
/// and the foot from ankle to ball are slender rods.
///
/// `footing` is the ground under the feet, on which the centres of pressure are placed. It is null on level ground.
void joint_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                  const Footing<Lanes<float>>* footing, GroundReaction<Lanes<float>>& reaction,
                  JointMoments<Lanes<float>>& moments);

/// Computes the forces of people animated by the host, from three poses `apart_s` seconds apart. The result applies to
/// the middle pose, which `motion` describes in the same frame. The ground is the floor of that frame, y = 0. Total and
/// moments are computed as in joint_forces. Without a plan, contact is detected from the poses. A foot bears load where
/// its heel, ball or toes are near the ground (less than 3 cm above it) and at rest (slower than 1.2 m/s). Within these
/// limits the load is split so that the motion balances best. The ground never pulls.
void posed_forces(const BodySize<Lanes<float>>& size, const BodyMotion<Lanes<float>>& motion,
                  const Pose<Lanes<float>>& before, const Pose<Lanes<float>>& now, const Pose<Lanes<float>>& after,
                  float apart_s, GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments);

}  // namespace mobil::inline v0_3
