// Curves common to the fibres and tendons of all muscles, in sixteen lanes (De Groote, Kinney, Rao, Fregly: Evaluation
// of direct collocation optimal control problem formulations for solving the muscle redundancy problem, Ann. Biomed.
// Eng. 44, 2016), with the corrected constants of OpenSim's DeGrooteFregly2016Muscle. See engine/wide-inl.h for how to
// include it.
#if defined(MOBIL_SYSTEMS_ACTIVATION_HILL_CURVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_ACTIVATION_HILL_CURVES_INL_H_
#undef MOBIL_SYSTEMS_ACTIVATION_HILL_CURVES_INL_H_
#else
#define MOBIL_SYSTEMS_ACTIVATION_HILL_CURVES_INL_H_
#endif

#include "engine/wide_exp-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Value and slope of a curve.
struct CurvePoint {
  Wide at, slope;
};

/// Adds b₁ exp(−½ ((m − b₂) · `over`)²), where `over` = 1/(b₃ + b₄ m).
HWY_INLINE void add_bell(const Wide& m, const float (&b)[4], const Wide& over, CurvePoint& sum) {
  const Wide off = (m - b[1]) * over;
  const Wide value = b[0] * exp(-0.5F * off * off);
  sum.at = sum.at + value;
  sum.slope = fnma(value * off, (b[2] + b[1] * b[3]) * over * over, sum.slope);  // d off / dm = (b₃ + b₂ b₄) over²
}

/// Returns the active force as a function of fibre length over optimal length: three bells.
MOBIL_WIDE_INLINE CurvePoint active_force(const Wide& m) {
  constexpr float wide_bell[4] = {0.815F, 1.055F, 0.162F, 0.063F}, low_bell[4] = {0.433F, 0.717F, -0.030F, 0.200F},
                  even_bell[4] = {0.1F, 1.0F, 0.353553391F, 0};
  const Wide first = fma(m, wide(wide_bell[3]), wide(wide_bell[2])),
             second = fma(m, wide(low_bell[3]), wide(low_bell[2]));
  const Wide both = wide(1.0F) / (first * second);  // one division instead of two
  CurvePoint sum{wide(0.0F), wide(0.0F)};
  add_bell(m, wide_bell, both * second, sum);
  add_bell(m, low_bell, both * first, sum);
  add_bell(m, even_bell, wide(1 / even_bell[2]), sum);
  return sum;
}

/// Returns the passive force of fibres longer than optimal: 1 at a strain of 0.6.
MOBIL_WIDE_INLINE CurvePoint passive_force(const Wide& m) {
  constexpr float shape = 4, strain = 0.6F, e4 = 54.59815F;
  const Wide rising = exp((shape / strain) * (min(m, 2.0F) - 1.0F));
  const WideMask slack = m <= 1.0F;
  const Wide zero = wide(0.0F);
  return {select(slack, zero, (rising - 1.0F) * (1 / (e4 - 1))),
          select(slack, zero, rising * (shape / strain / (e4 - 1)))};
}

/// Returns the active force as a function of fibre speed over maximum speed, shortening negative: 0 at −1, 1 at rest,
/// never below 0.
MOBIL_WIDE_INLINE CurvePoint force_at_speed(const Wide& v) {
  constexpr float d1 = -0.3211346127989808F, d2 = -8.149F, d3 = -0.374F, d4 = 0.8825327733249912F;
  const Wide x = fma(v, wide(d2), wide(d3));
  const Wide root = sqrt(fma(x, x, wide(1.0F)));
  const Wide arsinh = copy_sign(log(abs(x) + root), x);
  const Wide at = fma(arsinh, wide(d1), wide(d4)), zero = wide(0.0F);
  const WideMask pulls = at > zero;
  return {select(pulls, at, zero), select(pulls, wide(d1 * d2) / root, zero)};
}

/// Returns the tendon force over the isometric force, as a function of tendon length over slack length: 1 at a strain
/// of 4.9 %. A slack tendon resists with a very small force, which keeps its length defined.
inline constexpr float tendon_stiffness = 36.5665198F;  // ln 6 / 0.049
MOBIL_WIDE_INLINE CurvePoint tendon_force(const Wide& t) {
  const Wide rising = 0.2F * exp(tendon_stiffness * (min(t, 1.2F) - 1.0F));
  const Wide at = rising - 0.2F;
  const WideMask taut = at > -0.05F;
  return {select(taut, at, wide(-0.05F)), select(taut, tendon_stiffness * rising, wide(0.0F))};
}

/// Returns the cosine of a fibre's angle from its sine, which is height over fibre length.
MOBIL_WIDE_INLINE Wide fibre_cosine(const Wide& sine) {
  return sqrt(max(fnma(sine, sine, wide(1.0F)), wide(1e-6F)));
}

/// Bounds of the search for a fibre's length, over the optimal length.
MOBIL_WIDE_INLINE Wide shortest_fibre(const Wide& height) {
  return max(1.05F * height, wide(0.3F));
}
inline constexpr float longest_fibre = 1.8F;

/// Returns the fibre length over the optimal length at which the tendon pulls with `force`, a part of the isometric
/// force. `height`, the tendon's slack length and the path length are given over the optimal fibre length.
MOBIL_WIDE_INLINE Wide fibre_at(const Wide& height, const Wide& tendon, const Wide& path, const Wide& force) {
  const Wide stretch = fma(log(fma(force, wide(5.0F), wide(1.0F))), wide(1 / tendon_stiffness), wide(1.0F));
  const Wide along = fnma(tendon, stretch, path);
  return min(max(sqrt(fma(along, along, height * height)), shortest_fibre(height)), wide(longest_fibre));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
