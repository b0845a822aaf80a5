#pragma once
// A few vectors that all bellies of about one slenderness move along, from the stiffness and mass of a fine mesh.
//
// With displacement u = ψ·w + V·q (ψ the lift: what a held far face, one metre out, does to a belly of the middle
// slenderness, on the whole mesh; w its displacement; V's columns are zero on both faces that are held) the reduced
// problem of a body scaled by S across and l along, r = S / l, is of the size of q:
//   S²·l·(q̈ + α·q̇) + S·(A/r + B + r·C)·q + ω_f²·S²·l·F·q = loads,      VᵀM₁V = 1,
// where A, B, C and F are N×N and made once. The vectors are load-dependent: Krylov vectors of what pulls, and of
// gravity and the frame's acceleration where asked for, made into the few that hold most of the motion (by the
// controllability Gramian of position) of bodies in the middle and at both ends of the range of r, and small and large
// ones where a foundation tells them apart.
// Wilson, Yuan and Dickens, Earthquake Eng. Struct. Dyn. 10, 1982 (load-dependent vectors); Antoulas, Approximation of
// Large-Scale Dynamical Systems, 2005 (Gramians).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "assets/fem/critical_step.h"
#include "assets/fem/hexahedral_mesh.h"
#include "assets/fem/stiffness_terms.h"
#include "components/muscle.h"
#include "engine/error.h"

namespace mobil {

inline constexpr std::uint32_t most_vectors = 32;
inline constexpr std::size_t frame_inputs = 12;  // constant x y z, then the gradient's rows, as in FrameLoad

/// What drives and loads reduced bellies: of a held far face its displacement along z (m), of a sliding one the total
/// force along z (N), of a free one the total traction x, y, z (N); and, where the frame's loads are asked for, the
/// twelve numbers of FrameLoad after that.
constexpr std::uint32_t input_count(FarEnd far_end, bool frame_loads) {
  const std::size_t ends = far_end == FarEnd::free ? 3 : 1;
  return static_cast<std::uint32_t>(ends + (frame_loads ? frame_inputs : 0));
}

/// `corrected`: the reduced operators are extrapolated (Richardson, order 2) from those of the mesh and of the mesh
/// with every other node, which takes most of the mesh's own error away; cells must be even.
struct ReducedOptions {
  std::uint32_t vectors = 12;  // 1–32
  FarEnd far_end = FarEnd::held;
  bool frame_loads = false;
  bool corrected = true;
  double foundation_hz = 0;         // as MuscleOptions
  double damping_per_s = 8;         // what the vectors are chosen for; bodies may have another
  double middle_ratio = 1;          // of across to along
  double ratio_width = 1.05;        // r from middle / width to middle · width, 1–4; 1: that one body alone
  double middle_product = 0.9;      // of across and along; matters with a foundation alone
  Cells control_cells = {2, 2, 8};  // control points: this mesh's nodes, all of which the fine mesh has
};

/// Everything a body's reduced problem is made of. Matrices row-major, in the template's size (S = l = 1).
struct ReducedBasis {
  ReducedOptions options;
  Cells cells{};  // of the mesh that it is made on
  std::uint32_t vectors = 0, inputs = 0;
  double lowest_ratio = 1, highest_ratio = 1;

  std::vector<double> a, b, c;     // VᵀAV …, N×N, N/m
  std::vector<double> foundation;  // VᵀP·M₁·PV (P picks x and y), N×N; empty without a foundation
  double foundation_1_s2 = 0;      // ω_f²

  // Held far face: VᵀAψ …, VᵀP·M₁·Pψ and VᵀM₁ψ, N each; ψᵀAψ …, ψᵀP·M₁·Pψ, ψᵀM₁ψ. Else empty and 0.
  std::vector<double> lift_a, lift_b, lift_c, lift_foundation, lift_mass;
  double lift_energy_a = 0, lift_energy_b = 0, lift_energy_c = 0, lift_energy_foundation = 0, lift_kinetic = 0;
  // Else: Vᵀ·(unit traction), N×1 (z) or N×3.
  std::vector<double> traction;
  // VᵀM₁·(field of each of the twelve inputs over the template's rest positions), N×12; empty without frame loads. And
  // ψᵀM₁·field, 12, where the far face is held too.
  std::vector<double> frame, lift_frame;

  // Displacement of the control points: (1 + N) numbers for each of their 3·nodes components, node-major: ψ (0 where
  // there is no lift), then V. And what finds q from displacements of the control points less ψ·w, N × 3·nodes: least
  // squares weighted by mass.
  std::vector<float> shape;
  std::vector<double> control_weight;  // kg, one a node
  std::vector<double> fit;

  /// The motions of the body in the middle (a row each, over V), and what A, B, C and F are along them: nearly diagonal
  /// for all bodies of the range. By `truncated`.
  struct Turned {
    std::vector<double> vector, a, b, c, foundation;  // N×N
  } turned;
};

/// `fine` is the muscle's template mesh in cells that contain options.control_cells' nodes. Fails, in one line, on
/// options out of range, cells that do not nest (or are odd where `corrected`), a bad material or mesh.
/// Deterministic: the same bits on every machine of one kind of arithmetic. `fields`, if not null, becomes ψ (where
/// there is one) and the vectors over all displacements of the mesh, row-major, a row each. On a core of 2023 (EPYC
/// 9004), corrected, a range of ratios: {4, 4, 16} 0.06 s, with frame loads 0.13 s; {8, 8, 32} 1.2 and 1.8 s. One body
/// alone: {8, 8, 32} 1.0 s, {12, 12, 48} 5.6 s.
Result<ReducedBasis> make_reduced_basis(const HexahedralMesh& fine, const Material& material, Element element,
                                        const ReducedOptions& options, std::vector<double>* fields = nullptr);

/// The basis of its first `vectors` (1 to all of them), bit for bit as if made with so few.
ReducedBasis truncated(const ReducedBasis& basis, std::uint32_t vectors);

/// One body's own motions z = Eᵀ·(q + VᵀM₁ψ·w), E the eigenvectors of its reduced stiffness over its mass (EᵀE = 1),
/// fastest last: z̈ + α·ż + ω²·z = ω²·Σ P·input. Participations P are what z is at rest under each input, per unit.
struct ReducedBelly {
  std::uint32_t vectors = 0, inputs = 0;
  double omega_1_s[most_vectors];                        // ascending
  double eigenvector[most_vectors][most_vectors];        // [vector of V][motion]
  double participation[most_vectors][3 + frame_inputs];  // [motion][input]
  double lift_share[most_vectors];                       // [motion]: Eᵀ·VᵀM₁ψ; q = E·(z − lift_share·w)
  double reaction[3 + frame_inputs];  // held far face: force on it in rest under each input, N per unit; else 0
  double lift_mass_kg;                // S²·l·(ψᵀM₁ψ − |VᵀM₁ψ|²); 0 without a lift
};

/// The reduced problem of a body scaled by `across` and `along`, solved. Fails outside the basis's range of ratios (up
/// to rounding) or where the operator is not positive definite. No heap. On that core with 12 vectors 4.3 µs, with 16
/// 8.2 µs, with frame loads 5.5 and 9.7 µs, with 32 46 µs (reduced_belly_test --gtest_also_run_disabled_tests
/// --gtest_filter=*Microseconds).
Result<ReducedBelly> make_reduced_belly(const ReducedBasis& basis, double across, double along);

/// Numbers that the kernels take, laid out as systems/deformation/reduced.h says: `motion` of reduced_motion_width(),
/// `shape` of reduced_shape_width() floats.
constexpr std::size_t reduced_motion_width(std::uint32_t vectors, std::uint32_t inputs) {
  const std::size_t pairs = inputs > frame_inputs ? frame_inputs / 2 : 0, ends = inputs - 2 * pairs;
  return std::size_t{vectors} * (inputs == 1 ? 3 : 3 + ends + pairs);
}
constexpr std::size_t reduced_state_width(std::uint32_t vectors) {
  return 2 * std::size_t{vectors};
}
constexpr std::size_t reduced_shape_width(std::uint32_t vectors, std::uint32_t inputs) {
  return std::size_t{vectors} * (vectors + inputs) + 2 * std::size_t{vectors} + inputs + 1;
}
/// Coordinates q of displacements of the control points (m, 3·nodes) with the held end at `w` (m; 0 without a lift).
void fit_coordinates(const ReducedBasis& basis, double w, std::span<const float> displacement, std::span<double> q);

void write_motion(const ReducedBelly& belly, double damping_per_s, double tick_s, std::span<float> motion);
void write_shape(const ReducedBelly& belly, double damping_per_s, std::span<float> shape);

/// A belly's state from the displacement and velocity of its control points (3·nodes floats each, this body's m and
/// m/s) under `input` and its rates of change (per s), and back. To and fro, displacement and velocity are kept up to
/// what the vectors cannot show.
void fit_state(const ReducedBasis& basis, const ReducedBelly& belly, std::span<const double> input,
               std::span<const double> rate, std::span<const float> displacement, std::span<const float> velocity,
               std::span<float> state);
void show_state(const ReducedBasis& basis, const ReducedBelly& belly, std::span<const double> input,
                std::span<const double> rate, std::span<const float> state, std::span<float> displacement,
                std::span<float> velocity);

}  // namespace mobil
