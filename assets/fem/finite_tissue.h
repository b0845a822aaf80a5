#pragma once
// Tissue of a muscle's belly at finite strain: soft, nearly incompressible, with active fibres.

#include <cmath>

namespace mobil::inline v0_3 {

/// Parameters of the tissue. Ends are driven by displacement, so shapes follow only from the ratios of pressures.
struct FiniteTissue {
  double shear_pa = 4000;          // μ
  double bulk_over_shear = 200;    // κ' / μ
  double active_pa = 40e3;         // σ_V at full activation, where fibres are least crowded
  double passive_pa = 300e3;       // σ_P
  double rest_over_optimal = 0.9;  // fibre length at rest over the optimal length
  double force_slope = 4;          // of active stress over a fibre's stretch beyond the belly's
  double min_share = 0.05;         // of active stress that remains in fibres much shorter than the belly's
  double slack_tone = 1;           // activation added by slackness, over the square of the belly's shortening
  double density_kg_m3 = 1000;
};

/// Returns the effective activation of a belly shortened by e at activation a: 1 − (1 − a)(1 − e²) for e above 0.
/// Relaxed, shortened muscle hangs slack, but this tissue would be compressed. That twists flat bellies and folds
/// slender ones from e = 0.15 (soleus: points move by 19 mm at 0.25); the added tone holds them.
inline double pulling_activation(const FiniteTissue& tissue, double shortening, double activation) {
  const double tone = shortening > 0 ? tissue.slack_tone * shortening * shortening : 0;
  return 1 - (1 - activation) * (1 - tone);
}

/// Maximum crowding. Fibres run from end to end with equal force, so stress rises where sections shrink.
inline constexpr double max_crowding = 4;

/// Nominal stress along a fibre, Pa, and its slope over the stretch, where fibres are least crowded.
struct FibreTension {
  double stress_pa, slope_pa;
};

/// Returns T = a·σ_V·max(0.05, 1 + 4(λ − λ̄)) + σ_P·f_P(0.9 λ), λ̄ = `mean_stretch` of the whole belly, f_P(x) =
/// (e^(4(x − 1)/0.6) − 1)/(e⁴ − 1) above 1 (Thelen, J. Biomech. Eng. 125, 2003). T is never below 0, because elastic
/// fibres about λ = 1 buckle when shortened. The slope about λ̄ replaces the force–length curve, whose falling side
/// makes stretched bellies neck.
inline FibreTension fibre_tension(const FiniteTissue& tissue, double activation, double mean_stretch, double stretch) {
  FibreTension tension{};
  const double share = 1 + tissue.force_slope * (stretch - mean_stretch);
  const double active_pa = activation * tissue.active_pa;
  const bool floored = share < tissue.min_share;
  tension.stress_pa = active_pa * (floored ? tissue.min_share : share);
  tension.slope_pa = floored ? 0 : active_pa * tissue.force_slope;
  const double length = tissue.rest_over_optimal * stretch;
  if (length > 1) {
    constexpr double steepness = 4, strain = 0.6;
    const double most = std::expm1(steepness);
    const double grown = std::exp(steepness * (length - 1) / strain);
    tension.stress_pa += tissue.passive_pa * (grown - 1) / most;
    tension.slope_pa += tissue.passive_pa * grown * steepness / strain * tissue.rest_over_optimal / most;
  }
  return tension;
}

}  // namespace mobil::inline v0_3
