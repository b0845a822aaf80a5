#pragma once
// One step of the support model, solved so that it repeats: the hip ends it as high and moving just as it began.

#include <vector>

#include "engine/error.h"
#include "systems/gait/step_dynamics.h"

namespace mobil::step {

/// What the support solver is asked. The pivot of the leg is the origin; the hip starts half a step length behind it
/// at `strike_height_m` and ends half a step length ahead at the same height.
struct SupportRequest {
  SupportModel model;
  double duration_s, step_length_m;
  double strike_height_m;  // hip over the pivot at heel strike
  double mid_height_m;     // the same in mid-stance
  double stiffness_n_per_m, damping_n_s_per_m;
  double roll_over;  // how far the centre of pressure travels under the foot, of the hip's travel
  double trunk_lean_rad, trunk_stiffness_nm, trunk_damping_nm_s;
};

/// A moment of the solved step: hip place, velocity and acceleration relative to the pivot; trunk angle and rate.
struct HipSample {
  double forward_m, up_m, forward_velocity, up_velocity, forward_acceleration, up_acceleration;
  double trunk_rad, trunk_rate;
};

/// The solved step: samples at equal times from heel strike to the next heel strike, and the leg's and trunk's states
/// at both.
struct SupportStep {
  std::vector<HipSample> sample;
  SupportState first, last;
};

/// Newton shooting on {θ̇₁(0), ω̇(0), F_θ₁, push-off, delay, preload, θ₂(0), θ̇₂(0)} for {θ₁(T), ω(T), hip velocity (2),
/// hip height in mid-stance, no vertical speed just after heel strike, θ₂(T), θ̇₂(T)}, periodic to 1e-9 of their scales.
/// F_ω = k (ℓ + λ − ω) + c (ℓ̇ − ω̇): ℓ(t) is the length that knee and ankle give a leg whose hip goes evenly forward and
/// rises and falls as a sinusoid, λ the preload that bears the weight. F_θ₂ holds the trunk upright as a spring and
/// damper; F_θ₁ is its reaction, the turning moment, and the centre of pressure's travel under the foot. Fails, naming
/// the step, where no periodic step exists.
Result<SupportStep> solve_support(const SupportRequest& request);

}  // namespace mobil::step
