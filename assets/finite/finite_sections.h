#pragma once
// A belly's elements put together, section by section.

#include "assets/finite/finite_belly.h"

namespace mobil::inline v0_3 {

/// Where an element's corners are, m, its nodes moved by `displacement_m` (three a node).
Corners corners_of(const FiniteBelly& belly, const FiniteElement& element, const std::vector<double>& displacement_m);

/// How far along z the insertion face has moved when a belly is shortened so, m.
inline double end_of(const FiniteBelly& belly, double shortening) {
  return -shortening * belly.length_m;
}

/// What fibres of a belly do at a shortening and activation.
Activity activity_of(const FiniteBelly& belly, double shortening, double activation);

/// Minus the elements' forces on the nodes that move (scratch.residual_n), and their tangent (scratch.chain) with
/// `stiffening` times the shear stiffness on its diagonal. `pull_m`: how far the insertion face is yet to go, to first
/// order.
void assemble_elements(const FiniteBelly& belly, const Activity& activity, const std::vector<double>& displacement_m,
                       double stiffening, double pull_m, FiniteScratch& scratch);

}  // namespace mobil::inline v0_3
