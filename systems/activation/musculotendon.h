#pragma once
// A muscle in one dimension, after Hill: fibres, active and passive, in line with an elastic tendon, massless but
// damped, so that both pull alike (De Groote et al. 2016; curves: hill_curves-inl.h). With m the fibre's length over
// its optimal one, t the tendon's over its slack one, a the activation, v the fibre's speed over the fastest, ten
// optimal lengths a second, and α its angle, sin α = height / fibre:
//
//   (a f_L(m) f_V(v) + f_P(m) + 0.1 v) cos α = f_T(t),   fibre · cos α + tendon = length of the path
//
// The speed is the difference over the tick, so the step is implicit and stable for ticks of any length; up to 1/30 s
// it is solved within 0.1 % of the fibre. Four Newton steps always, from where fibres that do not move would be, as far
// as they can get there; each within a bracket that shrinks as bisection's does: 1.05 of the height or 0.3 of the
// optimal length, to 1.8 of it.

#include <cstddef>

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Sixteen rows of a muscle's `members`, column after column as the fields of mobil/components/activation.h are.
struct MemberBlock {
  std::size_t members;
  const float* weight;  // by member: shares of the volume, 1 together
  const MemberDesign<Lanes<float>>* design;
  const Lanes<float>* length_m;  // of the path
  const Lanes<float>* excitation;
  MemberState<Lanes<float>>* state;
};

/// A tick of `tick_s`. Activation follows excitation (Thelen: Adjustment of muscle mechanics model parameters to
/// simulate dynamic contractions in older adults, J. Biomech. Eng. 125, 2003): time constants 10 ms · (0.5 + 1.5 a)
/// rising and 40 ms / (0.5 + 1.5 a) falling, exact over the tick for that constant. Then the fibres. Writes state,
/// activation (both its fields) and muscle. A NaN stays in its lane, and is gone with the tick after the last.
void contract(const MemberBlock& of, float tick_s, Activation<Lanes<float>>& activation,
              Musculotendon<Lanes<float>>& muscle);

/// The same muscles at rest at these lengths: activation is the excitation, and fibres do not move.
void settle(const MemberBlock& of, Activation<Lanes<float>>& activation, Musculotendon<Lanes<float>>& muscle);

/// What activations must be for tendons to pull with `of_most` of the isometric force at the tick's end; no dynamics:
/// `state` has them at once, and so has `excitation`, for `contract` to go on with. Where fibres cannot, 1; where a
/// force is NaN, the least.
void ask_forces(const MemberBlock& of, const Lanes<float>* of_most, float tick_s, Lanes<float>* excitation);

/// The designs' `rest_belly_m` from their other numbers and the path's length in who stands relaxed: at the least
/// activation.
void find_rest_bellies(std::size_t members, const Lanes<float>* length_m, MemberDesign<Lanes<float>>* design);

}  // namespace mobil::inline v0_3
