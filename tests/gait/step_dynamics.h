#pragma once
// The two Lagrangian models of a step (paper, equation 1 and section 4.1), in double precision: the body over its
// support leg, and the swing leg hanging on a moving hip. Sagittal plane, y up, z forward, the support foot at the
// origin. Angles: θ₁, θ₂ from the upward vertical, forward positive; θ₃, θ₄ from the downward vertical, forward
// positive, so that knee flexion is θ₃ − θ₄.

#include <array>

namespace mobil::step {

/// Masses (kg), lengths (m) and moments of inertia (kg m²) of the support model: a leg of variable length ω with its
/// centre of mass at κω from the foot, the swing leg's mass at the hip, and the trunk (with head and arms) above it.
struct SupportModel {
  double leg_mass, leg_centre, leg_inertia;        // m₁, κ, I₁
  double hip_mass;                                 // m_h
  double trunk_mass, trunk_centre, trunk_inertia;  // m₂, r₂, I₂
};

/// q = [ω, θ₁, θ₂] in m and rad.
struct SupportState {
  std::array<double, 3> q, rate;
};

/// Returns q̈ under the generalised forces F_ω (N), F_θ₁, F_θ₂ (N m).
std::array<double, 3> support_acceleration(const SupportModel& model, const SupportState& state,
                                           const std::array<double, 3>& force);

/// Thigh and shank with foot: masses, lengths, centres of mass from the upper joint, central moments of inertia.
struct SwingModel {
  double thigh_mass, thigh_length, thigh_centre, thigh_inertia;  // m₃, l₃, r₃, I₃
  double shank_mass, shank_centre, shank_inertia;                // m₄, r₄, I₄
};

/// q = [θ₃, θ₄] in rad.
struct SwingState {
  std::array<double, 2> q, rate;
};

/// Returns q̈ under F_θ₃ = τ_hip − τ_knee and F_θ₄ = τ_knee (N m) while the hip accelerates by (forward, up) in m/s².
std::array<double, 2> swing_acceleration(const SwingModel& model, const SwingState& state,
                                         const std::array<double, 2>& force, const std::array<double, 2>& hip);

}  // namespace mobil::step
