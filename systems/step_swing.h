#pragma once
// The swing of one leg from toe-off to heel strike, solved so that it ends exactly on its next foothold.

#include <array>
#include <vector>

#include "engine/error.h"
#include "systems/step_leg.h"

namespace mobil::step {

/// A moment of the solved swing: joint angles and rates, the ankle's place as step_leg.h has it, the foot's pitch and
/// the toes' upward bend.
struct SwingSample {
  SwingState state;
  Point ankle;
  double pitch, toes;
};

/// Torques found (N m): at hip and knee, early and late in the swing. Samples at equal times, ends included.
struct Swing {
  std::vector<SwingSample> sample;
  SwingState target;
  std::array<double, 6> torque_nm;
  double lift_m;  // by how much the ankle was raised at most to keep the foot off the ground
};

/// Thigh and shank with foot of a body of this mass and leg.
SwingModel swing_model(const Leg& leg, double body_mass_kg);

/// Newton shooting on four torques, {hip, knee} × {early, late}, for the thigh's and shank's angles and rates at heel
/// strike; the knee also has a passive spring and damper that limit its flexion. The foot follows by interpolation
/// between its dorsiflexion at toe-off, in mid-swing and at heel strike, and is lifted where it would touch the
/// ground. Fails, naming the step, where no such swing exists.
Result<Swing> solve_swing(const Leg& leg, const SwingModel& model, const GaitStyle& style);

}  // namespace mobil::step
