#pragma once
// Excitation of the leg's muscles in walking, by phase and speed.
//
// Source: linear envelopes of surface EMG, Bovi, Rabuffetti, Mazzoleni, Ferrarin, A multiple-task gait analysis
// approach, Gait Posture 33, 2011; twenty young people at five speeds (assets/reference/bovi2011_emg.csv). Each is
// relative to the maximum of that muscle's signal in all tasks. Its relation to the muscle's maximum excitation is not
// published. `excitation_scale` is chosen so that the moments of plantarflexors and knee extensors equal the walk's
// own, which are fitted to measured ones (tests/activation/leg_moments_test.cpp). Heads of measured muscles use the
// measured curve. All other muscles, mostly of the hip, have the excitation that makes the moments of walks at minimum
// cost (systems/activation/moment_sharing.h), fitted in the same form. Standing tone is 0.05 in soleus and 0.02 in
// others, without a source.

#include <array>
#include <span>
#include <string_view>

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// Coefficients of the measured share, a sum of harmonics of the gait cycle: Σₖ (c₂ₖ₋₁ cos 2πkφ + c₂ₖ sin 2πkφ). They
/// are polynomials of the speed s, the walk's over √(g · leg): cᵢ = cᵢ₀ + cᵢ₁ s + cᵢ₂ s².
inline constexpr std::size_t excitation_harmonics = 6;
inline constexpr std::size_t excitation_terms = 2 * excitation_harmonics + 1;
using ExcitationTerms = std::array<std::array<float, 3>, excitation_terms>;

inline constexpr float excitation_scale = 2.4F;

/// Range of speeds to which the curves are fitted. Below it they fade to the standing tone in proportion to speed;
/// above it they stay as at its end.
inline constexpr float min_excitation_speed = 0.27F, max_excitation_speed = 0.61F;

struct ExcitationCurve {
  std::string_view name;  // the table's column, or a line of the leg
  ExcitationTerms terms;
};
/// Returns true if a line's curve is measured, on itself or on another head of the muscle.
bool is_measured(const MemberMuscle& line);
/// Returns the curves, one for each column of the table, in its order, then those of other lines.
std::span<const ExcitationCurve> excitation_curves();

/// Excitation of one muscle.
struct MemberExcitation {
  const ExcitationCurve* curve;
  float standing;
};
MemberExcitation member_excitation(const MemberMuscle& muscle);

/// Returns the excitation, 0.01 to 1, at a walk's phase (0–1 from the leg's own heel strike) and speed (over √(g ·
/// leg)). Computes in double what the tick computes in lanes (systems/activation/excitation.h).
double excitation(const MemberExcitation& of, double cycle, double speed);

}  // namespace mobil::inline v0_3
