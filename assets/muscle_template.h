#pragma once
// What all bellies of one shape share: mesh, operators, and the same once more as the kernels read it. Immutable.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "assets/critical_step.h"
#include "assets/hexahedral_mesh.h"
#include "assets/stiffness_terms.h"
#include "components/muscle.h"
#include "engine/error.h"

namespace mobil {

/// `damping_per_s` is α of the mass damping C = α·M (0–1000). The critical step is tabulated for individuals with
/// across / along between `lowest_ratio` and `highest_ratio` (0.1–10).
struct MuscleOptions {
  FarEnd far_end = FarEnd::held;
  double damping_per_s = 8;
  double lowest_ratio = 0.5, highest_ratio = 2;
};

/// Coefficients in the order in which the kernel walks: rows are the nodes from the second plane to the last, x
/// fastest; a row's neighbours are those that exist, except in the (fixed) first plane, x fastest.
struct KernelArrays {
  static constexpr std::size_t individual_words = 12;  // a pair's A, B, C, as in StencilPair
  static constexpr std::size_t shared_words = 9;       // a pair's 3×3 block at S = l = 1, row-major
  std::vector<float> individual, shared;
  // What single precision left of each node's coupling to itself, in the same words, one entry a node. With it a
  // translation costs no force, however the couplings were rounded: else slender bellies would bend to a wrong beat.
  std::vector<float> individual_rest, shared_rest;
  std::vector<std::size_t> plane_pair;       // first pair of each plane k, 0 for the planes 0 and 1
  std::vector<float> mass_kg, inverse_mass;  // one a node
  std::vector<float> far_share;              // part of a uniform traction on each node of the far face; sum 1
  std::vector<float> rest_m;                 // three a node
  std::vector<Quad> skin;                    // boundary, wound outwards
  float volume_m3 = 0;
  float damping_per_s = 0;
};

struct MuscleTemplate {
  HexahedralMesh mesh;
  Material material;
  MuscleOptions options;
  StiffnessTerms terms;
  CriticalSteps critical_steps;
  KernelArrays kernel;
};

/// Number of floats that one individual's displacement (or velocity) takes.
constexpr std::size_t nodal_width(const Cells& cells) {
  return 3 * std::size_t{node_count(cells)};
}

/// Fails on an inverted element, a bad material, damping or range of ratios.
Result<MuscleTemplate> make_muscle_template(HexahedralMesh mesh, const Material& material,
                                            const MuscleOptions& options);

}  // namespace mobil
