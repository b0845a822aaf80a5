#pragma once
// How hard people excite the muscles of their legs as they walk: by phase and speed.
//
// Source: linear envelopes of surface EMG, Bovi, Rabuffetti, Mazzoleni, Ferrarin: A multiple-task gait analysis
// approach, Gait Posture 33, 2011; twenty young people at five speeds (assets/reference/bovi2011_emg.csv), each a share
// of what that muscle's signal was at most in any of the tasks. What share of the most that the muscle can that is, is
// not published: `excitation_scale` is chosen so that the plantarflexors' and knee extensors' moments that follow are
// as large as the walk's own, which is fitted to measured ones (tests/activation/leg_moments_test.cpp). Muscles that
// were not measured are excited as their neighbour: `measured_muscle`. Standing tone: soleus 0.05, others 0.02, which
// has no source.

#include <array>
#include <span>
#include <string_view>

#include <mobil/muscle_table.h>

namespace mobil::inline v0_3 {

/// The measured share, a sum of harmonics of the gait cycle whose coefficients are polynomials of speed s, the walk's
/// over √(g · leg): Σₖ (c₂ₖ₋₁ cos 2πkφ + c₂ₖ sin 2πkφ), cᵢ = cᵢ₀ + cᵢ₁ s + cᵢ₂ s².
inline constexpr std::size_t excitation_harmonics = 6;
inline constexpr std::size_t excitation_terms = 2 * excitation_harmonics + 1;
using ExcitationTerms = std::array<std::array<float, 3>, excitation_terms>;

inline constexpr float excitation_scale = 2.4F;

/// The speeds that the curves are fitted to begin and end at these. Below the first they pass to the standing tone in
/// proportion to speed; beyond the second they are as there.
inline constexpr float min_excitation_speed = 0.27F, max_excitation_speed = 0.61F;

struct ExcitationCurve {
  std::string_view measured_muscle;  // the table's column
  ExcitationTerms terms;
};
/// One for each column of the table, in its order.
std::span<const ExcitationCurve> excitation_curves();

/// How one muscle is excited.
struct MemberExcitation {
  const ExcitationCurve* curve;
  float standing;
};
MemberExcitation member_excitation(const MemberMuscle& muscle);

/// Of a walk's phase (0–1 from the leg's own heel strike) and speed (over √(g · leg)): 0.01 to 1. In double, what the
/// tick computes in lanes (systems/activation/excitation.h).
double excitation(const MemberExcitation& of, double cycle, double speed);

}  // namespace mobil::inline v0_3
