#pragma once
// Statics of one belly at finite strain, in double: the shape of its tissue when its ends approach and its fibres are
// active. The origin face is fixed; the insertion face is held sideways and moved by −e·l along z.

#include <array>
#include <cstddef>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/engine/error.h>
#include "assets/fem/finite_element.h"
#include "assets/fem/finite_tissue.h"
#include "assets/finite/section_chain.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A belly at finite strain. Fascia holds each section by a spring on its mean sideways displacement, (2πf)² times its
/// mass. Bellies can bulge, but long, thin and bent ones do not bow aside.
struct FiniteBelly {
  HexahedralMesh mesh;
  FiniteTissue tissue;
  double length_m = 0, foundation_hz = 0;
  std::vector<FiniteElement> elements;
  std::vector<double> node_mass_kg, section_mass_kg;  // from the density, lumped
};

/// A shape and its load: shortening e over the length at rest, activation 0–1, three displacements a node.
struct FiniteState {
  double shortening = 0, activation = 0;
  std::vector<double> displacement_m;
};

/// Working memory of a solve, for all bellies of one mesh size.
struct FiniteScratch {
  SectionChain chain;
  Eigen::VectorXd residual_n, step_m;
  /// Counters of Newton steps, of tangents that were stiffened and of loads that were halved.
  std::size_t iterations = 0, stiffened = 0, halvings = 0;
};

/// Fails on a mesh of one layer, an inverted element (naming one), or a foundation outside 0–1000 Hz.
Result<FiniteBelly> make_finite_belly(HexahedralMesh mesh, const FiniteTissue& tissue, double foundation_hz);

FiniteState state_at_rest(const FiniteBelly& belly);
FiniteScratch make_scratch(const FiniteBelly& belly);

/// Follows the static shape from `state` to another shortening and activation by Newton's method, halving the load if
/// that does not converge. Fails if a 64th of the way is still too much, and leaves `state` at the last load that
/// converged. Also fails on arguments outside −0.5…0.5 and 0…1.
Result<void> settle(const FiniteBelly& belly, FiniteScratch& scratch, FiniteState& state, double shortening,
                    double activation);

/// Returns the mean sideways displacement, by mass, of each of the nz + 1 planes of nodes: x and y, m.
std::vector<std::array<double, 2>> section_means(const FiniteBelly& belly, const FiniteState& state);

/// Returns the volume over that at rest.
double volume_ratio(const FiniteBelly& belly, const FiniteState& state);

/// Returns the maximum of |J̄ − 1| over elements.
double worst_dilatation(const FiniteBelly& belly, const FiniteState& state);

}  // namespace mobil::inline v0_3
