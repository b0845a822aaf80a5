#pragma once
// Assembly of a belly's elements, section by section.

#include "assets/finite/finite_belly.h"

namespace mobil::inline v0_3 {

/// Returns an element's corners, m, with its nodes moved by `displacement_m` (three a node).
Corners corners_of(const FiniteBelly& belly, const FiniteElement& element, const std::vector<double>& displacement_m);

/// Returns the displacement along z of the insertion face at a shortening, m.
inline double end_of(const FiniteBelly& belly, double shortening) {
  return -shortening * belly.length_m;
}

/// Returns the activity of a belly's fibres at a shortening and activation.
Activity activity_of(const FiniteBelly& belly, double shortening, double activation);

/// Assembles minus the elements' forces on the nodes that move (scratch.residual_n), and their tangent (scratch.chain)
/// with `stiffening` times the shear stiffness on its diagonal. `pull_m` is the remaining way of the insertion face, to
/// first order.
void assemble_elements(const FiniteBelly& belly, const Activity& activity, const std::vector<double>& displacement_m,
                       double stiffening, double pull_m, FiniteScratch& scratch);

}  // namespace mobil::inline v0_3
