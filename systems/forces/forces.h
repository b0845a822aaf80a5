#pragma once
// From the motion of the skeleton to the reaction of the ground and the moments at the joints (paper, section 4.3).

#include "components/body.h"
#include "components/forces.h"
#include "components/gait.h"
#include "components/pose.h"

namespace mobil {

/// Ground reaction of each foot and sagittal moments at hip, knee and ankle, by free-body diagrams from the foot up.
///
/// WHICH INSTANT. Accelerations are central differences over three ticks, so what is written belongs to the tick
/// BEFORE the present pose: row n of a record of poses goes with what is written at row n + 1. The first two ticks
/// after an all-zero history write zero. `tick_s` is that of all three ticks. Positions are single precision: the
/// force's noise is about mass · 1e-7 · distance from the origin / tick², 1 % of the weight at 60 Hz some 250 m out.
///
/// TOTAL. mass · (acceleration of the centre of mass + g), the centre being that of all 48 segments.
/// SPLIT. In double support the support foot's share of the vertical force goes from plan.load_from to plan.load_to as
/// 1 − (1 − u)²(1 + 1.3 u), u the part of double support that is over. Fore-aft and sideways each foot's force
/// leans toward one point over the body, as high as 1.4 times its centre of mass; what the feet's forces then lack to
/// the total is shared like the vertical force, so that their sum is exactly the total.
/// CENTRE OF PRESSURE. It rolls along the foot with the slope of the line from hip to ankle, as on a rocker with soft
/// ends (roll-over shape, Hansen, Childress & Knox 2004), within the part of the sole that is down; as the heel rises
/// it goes on toward the toes. A body at rest is balanced instead: centres of pressure and shares are such that the
/// total acts where it makes no moment about the centre of mass, as far as the soles reach. The less speed, the more
/// so.
/// The numbers in these rules are fitted to ground reactions, angles and ankle moments of Winter (1991) and Schwartz,
/// Rozumalski & Trost (2008), slow, natural and fast.
/// MOMENTS. About the horizontal axis through the joint, across the mean direction that the two thighs face. Thigh with
/// kneecap, shank, and foot with toes have Winter's radii of gyration; thigh and shank are slender rods, and so is the
/// foot from ankle to ball.
void joint_forces(const BodySize<Lanes<float>>& size, const Pose<Lanes<float>>& pose, const Feet<Lanes<float>>& feet,
                  const CentreOfMass<Lanes<float>>& centre, const StepPlan<Lanes<float>>& plan,
                  const GaitState<Lanes<float>>& state, MotionHistory<Lanes<float>>& history,
                  GroundReaction<Lanes<float>>& reaction, JointMoments<Lanes<float>>& moments, float tick_s);

}  // namespace mobil
