#pragma once
// Stiffness of a belly along its line: the k of equations 2 and 3, computed from its mesh.

#include <span>
#include <vector>

#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

/// A belly whose far face is held one metre out, statically: displacement of every node (three a node, m per m), and
/// total force along z on that face (N per m).
struct StaticStretch {
  std::vector<double> displacement;
  double stiffness_n_per_m = 0;
};

/// Stretches a body scaled by `across` and `along`. The origin face is fixed; the far face is held sideways and moves
/// as one. `foundation_hz` holds every node sideways with (2πf)² times its lumped mass (muscle_template.h). Uses
/// conjugate gradients to 1e-10, with the same bits on every machine.
StaticStretch static_stretch(const StiffnessTerms& terms, double across, double along, double foundation_hz = 0);

/// Returns the stiffness of the same belly with a far face that can warp, N/m: the total of a uniform traction along z
/// over its mean displacement along z. `far_share` is the part of the traction on each node of the far face, sum 1.
double pulled_stiffness(const StiffnessTerms& terms, std::span<const float> far_share, double across, double along);

/// Stiffness of every individual of a template: `across` · κ(r), r = across / along, with κ(r) / r tabulated.
struct AxialStiffness {
  std::vector<double> ratio;      // ascending
  std::vector<double> per_ratio;  // κ(r) / r there, N/m
};

/// Tabulates r from `lowest` to `highest` (0 < lowest ≤ highest) in steps of at most 20 %.
AxialStiffness tabulate_axial_stiffness(const StiffnessTerms& terms, std::span<const float> far_share, double lowest,
                                        double highest);

/// Returns N/m; ratios outside the table take its end.
double axial_stiffness(const AxialStiffness& table, double across, double along);

}  // namespace mobil::inline v0_3
