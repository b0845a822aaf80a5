#pragma once
// The swing of one leg from toe-off to heel strike, solved so that it ends exactly on its next foothold.

#include <vector>

#include "engine/error.h"
#include "systems/gait/step_leg.h"

namespace mobil::step {

/// A moment of the solved swing: joint angles and rates, the ankle's place as step_leg.h has it, the foot's pitch and
/// the toes' upward bend.
struct SwingSample {
  SwingState state;
  Point ankle;
  double pitch, toes;
};

/// Samples at equal times from toe-off to heel strike, both included; the state that was aimed at.
struct Swing {
  std::vector<SwingSample> sample;
  SwingState target;
};

/// Thigh and shank with foot of a body of this mass and leg.
SwingModel swing_model(const Leg& leg, double body_mass_kg);

/// Newton shooting on six torques, two pushes at the hip and four at the knee, for the angles and rates of thigh and
/// shank at heel strike and the knee's greatest flexion; the knee also has a passive spring and damper. The foot
/// follows by interpolation between its dorsiflexion at toe-off, in mid-swing and at heel strike, and is lifted where
/// it would come nearer to the ground than toe_clearance_m. Fails, naming the step, where no such swing exists.
Result<Swing> solve_swing(const Leg& leg, const SwingModel& model, const GaitStyle& style);

}  // namespace mobil::step
