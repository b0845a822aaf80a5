#pragma once
// The arrays of a modal basis in order, for fingerprints and files.

#include <cstddef>

#include "assets/reduction/modal_basis.h"

namespace mobil::inline v0_3 {

/// Calls f(array, length) with each array of a basis (const or not) in a fixed order. The lengths follow from its
/// options. The motions of its middle body (`turned`) can be missing: their lengths are then 0.
template <class Basis, class F>
void each_array(Basis& basis, bool has_turned, F&& f) {
  const ModalBasisOptions& o = basis.options;
  const std::size_t n = basis.modes, nodes = node_count(o.control_cells);
  const bool braced = o.foundation_hz > 0;
  const std::size_t held = o.far_end == FarEnd::held ? 1 : 0, framed = o.frame_loads ? frame_inputs : 0;
  const std::size_t ends = o.far_end == FarEnd::free ? 3 : 1;
  for (auto* const square : {&basis.a, &basis.b, &basis.c}) f(*square, n * n);
  f(basis.foundation, braced ? n * n : 0);
  f(basis.tension, n * n);
  for (auto* const lift : {&basis.lift_a, &basis.lift_b, &basis.lift_c, &basis.lift_mass}) f(*lift, held * n);
  f(basis.lift_foundation, braced ? held * n : 0);
  f(basis.traction, (1 - held) * ends * n);
  f(basis.frame, framed * n);
  f(basis.lift_frame, held * framed);
  f(basis.shape, 3 * nodes * (n + 1));
  f(basis.control_weight, nodes);
  f(basis.fit, n * 3 * nodes);
  auto& turned = basis.turned;
  for (auto* const square : {&turned.vector, &turned.a, &turned.b, &turned.c}) f(*square, has_turned ? n * n : 0);
  f(turned.foundation, has_turned && braced ? n * n : 0);
  f(turned.tension, has_turned ? n * n : 0);
}

/// Calls f(number) with each of a basis' single numbers.
template <class Basis, class F>
void each_number(Basis& basis, F&& f) {
  for (auto* const number : {&basis.lift_energy_a, &basis.lift_energy_b, &basis.lift_energy_c,
                             &basis.lift_energy_foundation, &basis.lift_kinetic}) {
    f(*number);
  }
}

}  // namespace mobil::inline v0_3
