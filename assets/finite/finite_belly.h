#pragma once
// Statics of one belly at finite strain, in double: the shape that its tissue takes when its ends come nearer and its
// fibres pull. The origin face is fixed; the insertion face is held sideways and moved by −e·l along z.

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

/// Fascia holds each section where it is by a spring on the mean of its displacement sideways, (2πf)² times its mass:
/// bellies may bulge, but long, thin and bent ones do not bow aside.
struct FiniteBelly {
  HexahedralMesh mesh;
  FiniteTissue tissue;
  double length_m = 0, foundation_hz = 0;
  std::vector<FiniteElement> elements;
  std::vector<double> node_mass_kg, section_mass_kg;  // of the density, lumped
};

/// A shape and what it belongs to: shortening e over the length at rest, activation 0–1, three displacements a node.
struct FiniteState {
  double shortening = 0, activation = 0;
  std::vector<double> displacement_m;
};

/// What a solve works with; of one mesh's size, any belly of it.
struct FiniteScratch {
  SectionChain chain;
  Eigen::VectorXd residual_n, step_m;
  /// Counted up: Newton's steps; tangents that had to be stiffened; loads that had to be halved.
  std::size_t iterations = 0, stiffened = 0, halvings = 0;
};

/// Fails on a mesh of one layer, on elements that are inverted (naming one), and on a foundation outside 0–1000 Hz.
Result<FiniteBelly> make_finite_belly(HexahedralMesh mesh, const FiniteTissue& tissue, double foundation_hz);

FiniteState state_at_rest(const FiniteBelly& belly);
FiniteScratch make_scratch(const FiniteBelly& belly);

/// Follows the static shape from where `state` is to another shortening and activation, by Newton's method, the load
/// halved where that does not converge. Fails, the state then left at the last load that did, when a 64th of the way is
/// still too much or the arguments lie outside −0.5…0.5 and 0…1.
Result<void> settle(const FiniteBelly& belly, FiniteScratch& scratch, FiniteState& state, double shortening,
                    double activation);

/// Mean displacement sideways of each plane of nodes, by mass: x and y, m; nz + 1 of them.
std::vector<std::array<double, 2>> section_means(const FiniteBelly& belly, const FiniteState& state);

/// Volume over that at rest.
double volume_ratio(const FiniteBelly& belly, const FiniteState& state);

/// Largest of |J̄ − 1| over elements.
double worst_dilatation(const FiniteBelly& belly, const FiniteState& state);

}  // namespace mobil::inline v0_3
