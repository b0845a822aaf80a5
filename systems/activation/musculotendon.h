#pragma once
// One-dimensional muscles after Hill: active and passive fibres in series with an elastic tendon. Fibres are massless
// but damped, so both exert the same force (De Groote et al. 2016; curves: hill_curves-inl.h).

#include <cstddef>

#include <mobil/components/activation.h>
#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Sixteen rows of a muscle's `members`, in columns like the fields of mobil/components/activation.h.
struct MemberBlock {
  std::size_t members;
  const float* weight;  // by member: shares of the volume, sum 1
  const MemberDesign<Lanes<float>>* design;
  const Lanes<float>* length_m;  // of the path
  const Lanes<float>* excitation;
  MemberState<Lanes<float>>* state;
};

/// Advances the muscles by a tick of `tick_s`. Activation follows excitation (Thelen: Adjustment of muscle mechanics
/// model parameters to simulate dynamic contractions in older adults, J. Biomech. Eng. 125, 2003). Its time constants
/// are 10 ms · (0.5 + 1.5 a) rising and 40 ms / (0.5 + 1.5 a) falling, integrated exactly over the tick for that
/// constant. Then the fibres are solved:
///
///   (a f_L(m) f_V(v) + f_P(m) + 0.1 v) cos α = f_T(t),   fibre · cos α + tendon = length of the path
///
/// Here a is the activation, m the fibre length over its optimal length, and t the tendon length over its slack length.
/// v is the fibre speed over the maximum of ten optimal lengths a second, and α the fibre's angle, sin α = height /
/// fibre. The speed is the difference over the tick, so the step is implicit and stable for ticks of any length. Up to
/// 1/30 s it is solved within 0.1 % of the fibre.
///
/// Each tick runs four Newton steps. They start at the equilibrium of fibres at rest, as far as the fibres can get
/// there. Each step stays in a bracket that shrinks as in bisection, initially from 1.05 of the height or 0.3 of the
/// optimal length to 1.8 of the optimal length. Writes state, both fields of activation, and muscle. A NaN stays in its
/// lane and disappears one tick after its last input.
void contract(const MemberBlock& of, float tick_s, Activation<Lanes<float>>& activation,
              Musculotendon<Lanes<float>>& muscle);

/// Sets the muscles to rest at these lengths: activation equals excitation, and fibres do not move.
void settle(const MemberBlock& of, Activation<Lanes<float>>& activation, Musculotendon<Lanes<float>>& muscle);

/// Writes the excitations with which tendons pull with `of_most` of the isometric force at the end of the tick.
/// Activation dynamics are not inverted: the value is the activation needed, which `contract` then follows. It is 1
/// where fibres cannot reach the force, and the minimum where a force is NaN.
void ask_forces(const MemberBlock& of, const Lanes<float>* of_most, float tick_s, Lanes<float>* excitation);

/// Writes the designs' `rest_belly_m` from their other fields and a relaxed person's path lengths, at minimum
/// activation.
void find_rest_bellies(std::size_t members, const Lanes<float>* length_m, MemberDesign<Lanes<float>>* design);

}  // namespace mobil::inline v0_3
