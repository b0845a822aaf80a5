#pragma once
// A few modes shared by all bellies of about one slenderness, from the stiffness and mass of a fine mesh.
//
// Displacement is u = ψ·w + V·q. The modal problem of a body scaled by S across and l along, r = S / l, is
//   S²·l·(q̈ + α·q̇) + S·(A/r + B + r·C)·q + ω_f²·S²·l·F·q = loads,      VᵀM₁V = 1.
// ψ is the lift, the displacement of the whole mesh of a belly of the middle slenderness whose held far face is one
// metre out, and w that face's displacement. V's columns are zero on both held faces. A, B, C and F are N×N and made
// once. The modes are load-dependent: Krylov vectors of the pulls, and of gravity and the frame's acceleration if
// requested. They are made into the few that hold most of the motion (by the controllability Gramian of position). It
// is that of bodies in the middle and at both ends of the range of r, small and large if a foundation is present.
// Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10, 1982 (load-dependent modes); Antoulas, Approximation of
// Large-Scale Dynamical Systems, 2005 (Gramians).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stiffness_terms.h"

namespace mobil::inline v0_3 {

inline constexpr std::uint32_t max_modes = 32;
inline constexpr std::size_t frame_inputs = 12;  // constant x y z, then the gradient's rows, as in FrameLoad

/// Returns the number of inputs that drive and load modal bellies. A held far face has its displacement along z (m), a
/// sliding one the total force along z (N), a free one the total traction x, y, z (N). Frame loads, if requested, add
/// the twelve numbers of FrameLoad.
constexpr std::uint32_t input_count(FarEnd far_end, bool frame_loads) {
  const std::size_t ends = far_end == FarEnd::free ? 3 : 1;
  return static_cast<std::uint32_t>(ends + (frame_loads ? frame_inputs : 0));
}

/// `corrected` extrapolates the modal operators (Richardson, order 2) from those of the mesh and of the mesh with every
/// other node. That removes most of the mesh's own error; cells must be even.
struct ModalBasisOptions {
  std::uint32_t modes = 12;  // 1–32
  FarEnd far_end = FarEnd::held;
  bool frame_loads = false;
  bool corrected = true;
  double foundation_hz = 0;         // as MuscleOptions
  double damping_per_s = 8;         // for which the modes are chosen; bodies can have another
  double middle_ratio = 1;          // of across to along
  double ratio_width = 1.05;        // r from middle / width to middle · width, 1–4; 1: only that body
  double middle_product = 0.9;      // of across and along; used only with a foundation
  Cells control_cells = {2, 2, 8};  // control points: this mesh's nodes, all of which the fine mesh has
};

/// Data of bodies' modal problems. Matrices row-major, in the template's size (S = l = 1).
struct ModalBasis {
  static constexpr std::uint64_t stable_id = 0xb4aa58b9eac07a28;
  ModalBasisOptions options;
  Cells cells{};  // of the mesh on which it is made
  std::uint32_t modes = 0, inputs = 0;
  double lowest_ratio = 1, highest_ratio = 1;

  std::vector<double> a, b, c;     // VᵀAV …, N×N, N/m
  std::vector<double> foundation;  // VᵀP·M₁·PV (P picks x and y), N×N; empty without a foundation
  double foundation_1_s2 = 0;      // ω_f²
  /// Stiffness of fibres at full activation over the mass, times l² (modal_tension.h): VᵀGV of a body of the middle
  /// ratio over r², N×N, m²/s². Bodies of the range differ from it as little as their fibres' directions do.
  std::vector<double> tension;

  // Held far face: VᵀAψ …, VᵀP·M₁·Pψ and VᵀM₁ψ, N each; ψᵀAψ …, ψᵀP·M₁·Pψ, ψᵀM₁ψ. Else empty and 0.
  std::vector<double> lift_a, lift_b, lift_c, lift_foundation, lift_mass;
  double lift_energy_a = 0, lift_energy_b = 0, lift_energy_c = 0, lift_energy_foundation = 0, lift_kinetic = 0;
  // Other far faces: Vᵀ·(unit traction), N×1 (z) or N×3.
  std::vector<double> traction;
  // VᵀM₁·(field of each of the twelve inputs over the template's rest positions), N×12; empty without frame loads. With
  // a held far face also ψᵀM₁·field, 12.
  std::vector<double> frame, lift_frame;

  // Displacement of the control points, (1 + N) numbers for each of their 3·nodes components, node-major: ψ (0 without
  // a lift), then V. `fit`, N × 3·nodes, gives q from displacements of the control points less ψ·w, by least squares
  // weighted by mass.
  std::vector<float> shape;
  std::vector<double> control_weight;  // kg, one a node
  std::vector<double> fit;

  /// Motions of the body in the middle (a row each, over V), and A, B, C, F and the tension along them, which are
  /// nearly diagonal for all bodies of the range. Made by `truncated`.
  struct Turned {
    std::vector<double> vector, a, b, c, foundation, tension;  // N×N
  } turned;
};

/// Returns a basis of that many modes of a mesh of those cells without its arrays, which need a mesh. Fails on options
/// out of range, or cells that do not nest (or are odd if `corrected`).
Result<ModalBasis> basis_outline(const Cells& cells, const ModalBasisOptions& options);

/// Makes a basis. `fine` is the muscle's template mesh in cells that contain options.control_cells' nodes. Fails, in
/// one line, on options out of range, cells that do not nest (or are odd if `corrected`), a bad material or mesh.
/// Deterministic: the same bits on every machine of one kind of arithmetic. `fields`, if not null, becomes ψ (if any)
/// and the modes over all displacements of the mesh, row-major, a row each. On a core of 2023 (EPYC 9004), corrected, a
/// range of ratios: {4, 4, 16} 0.06 s, with frame loads 0.13 s; {8, 8, 32} 1.2 and 1.8 s. One body alone: {8, 8, 32}
/// 1.0 s, {12, 12, 48} 5.6 s.
Result<ModalBasis> make_modal_basis(const HexahedralMesh& fine, const Material& material, Element element,
                                    const ModalBasisOptions& options, std::vector<double>* fields = nullptr);

/// Returns the basis of its first `modes` (1 to all of them), bit-identical to one made with so few.
ModalBasis truncated(const ModalBasis& basis, std::uint32_t modes);

}  // namespace mobil::inline v0_3
