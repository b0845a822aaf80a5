#pragma once
// A muscle of one leg: its owner, its size against its template, its line of action, its moving nodes.
// Mechanics: a linear elastic belly in the frame of its line of action, z from origin to insertion; a left muscle is
// solved as a right one and reflected when drawn.

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// One of the table's muscles (mobil/muscle_table.h): a group of muscles that act alike, or one muscle on its
/// own. Groups have names here; the others are numbered as the table's rows and found by `find_muscle("soleus")`.
enum class Muscle : std::uint8_t { hamstrings, quadriceps, triceps_surae, tibialis_anterior };
inline constexpr std::size_t muscle_group_count = 4;

/// Some of them, by number.
inline constexpr std::size_t max_muscles = 32;
using MuscleSet = std::bitset<max_muscles>;

/// Elements of a belly's mesh along x, y and z.
using Cells = std::array<std::uint32_t, 3>;

/// Linear elastic material. The defaults are the paper's (section 6.1).
struct Material {
  double density_kg_m3 = 1000.0;  ///< 1 to 1e6
  double young_pa = 1.06667e4;    ///< 1 to 1e12
  double poisson = 0.3333;        ///< -0.99 to 0.4999

  friend bool operator==(const Material&, const Material&) = default;
};

/// How displacements within an eight-node hexahedron become stiffness: at 2×2×2 Gauss points; the same with the
/// dilatation taken as its mean over the element (B-bar, for nearly incompressible tissue); at one point, with
/// stiffness against the hourglass modes that it does not see.
enum class Element : std::uint8_t { full, bbar, one_point };
inline constexpr std::array<std::string_view, 3> element_name = {"full", "bbar", "one-point"};

/// What stiffness is: small strains, K·u; or finite strain with fibres that pull (assets/fem/finite_kernel.h).
enum class Strain : std::uint8_t { small, finite };

/// How a belly's motion follows from its loads (section 6.3 of the paper): K·u = f; explicit central differences with
/// the lumped mass (ECD); implicit central differences, that is with the consistent mass (ICD); constant average
/// acceleration (CAA); a few modes of a finer mesh, each of whose motions is integrated exactly (modal); not at
/// all (none: the line of action alone); or central differences at finite strain (finite), for close-ups.
enum class Method : std::uint8_t { statics, explicit_central, implicit_central, newmark, modal, none, finite };
inline constexpr std::array<std::string_view, 7> method_name = {
    "static", "explicit-central", "implicit-central", "newmark", "modal", "none", "finite"};
inline constexpr Method last_method = Method::finite;

/// Mass matrix: lumped at the nodes (diagonal), or consistent with the shape functions.
enum class Mass : std::uint8_t { lumped, consistent };
inline constexpr std::array<std::string_view, 2> mass_name = {"lumped", "consistent"};

/// The person a muscle belongs to: entity index and generation, and the side of the body.
template <class F>
struct MuscleOwner {
  UInt32<F> index, generation, side;
};

/// Size of a belly against its template: x and y are S = `across` times the template's, z is l = `along` times it. With
/// r = S / l the stiffness is K = S·(A/r + B + r·C) and the lumped mass S²·l·M₁, where A, B, C and M₁ are the
/// template's (assets/fem/stiffness_terms.h).
template <class F>
struct BellyScale {
  F across, along;
};

/// Line of action. `force_n` = −stiffness·(length − rest_length), the visual force of a soft bar (equations 2 and 3 of
/// the paper), not a physiological one. `rotation` and `start_m` carry the muscle's frame into the world: origin at the
/// origin-side end of the belly's straight span, z along it. For a left muscle the frame is the mirror image's.
template <class F>
struct LineOfAction {
  F length_m, rest_length_m;
  F stiffness_n_per_m, force_n;
  Vec3<F> start_m;
  Quat<F> rotation;
};

/// What a line of action does: how fast its length grew over the last tick, m/s; and its moment arms −∂L/∂θ, m, about
/// the hip's and the knee's flexion and the ankle's dorsiflexion, positive where the muscle flexes. Of a group: the
/// mean of its members', weighted as its length is. `length_m` is the length that the speed was taken at, 0 before the
/// first.
template <class F>
struct LineMotion {
  F length_m, speed_m_s;
  F hip_flexion_arm_m, knee_flexion_arm_m, ankle_dorsiflexion_arm_m;
};

/// What the insertion face of a belly may do; the origin face is always fixed. `held`: every displacement of it is
/// prescribed. `sliding`: held sideways, free along z. `free`: free in all directions. As a tag (TagValue<FarEnd>) what
/// a table's EndDrive means.
enum class FarEnd : std::uint8_t { held, sliding, free };

/// What drives the far end of the belly along z at the tick's start and end: where it is `held` its displacement, m;
/// where it is `sliding` the total force along +z, N.
template <class F>
struct EndDrive {
  F from, to;
};

/// What loads a free far end: total of a uniform traction over it at the tick's start and end, N.
template <class F>
struct EndTraction {
  Vec3<F> from_n, to_n;
};

/// Rows of a 3×3 matrix.
template <class F>
struct Mat3 {
  Vec3<F> x, y, z;
};

/// What a belly feels of gravity and of its frame's motion: a mass at rest position x (m, in the muscle's frame) is
/// accelerated by `constant` + `gradient`·x, m/s² and 1/s², at the tick's start and end. In a frame with acceleration
/// a, angular velocity ω and angular acceleration α, constant = g − a and gradient·x = −α×x − ω×(ω×x).
template <class F>
struct FrameLoad {
  Vec3<F> constant_from, constant_to;
  Mat3<F> gradient_from, gradient_to;
};

/// Where a muscle's frame was at the last tick and how it got there from the one before: its origin, m; its rotation;
/// the step of its origin, m, and its turn as a rotation vector in the world, rad. `known`: 0 nothing of it, 1 the
/// place alone, 2 all.
template <class F>
struct FrameHistory {
  Vec3<F> start_m, step_m;
  Quat<F> rotation;
  Vec3<F> turn_rad;
  UInt32<F> known;
};

/// What a deforming belly did, written once a tick. Elongation: mean displacement of the far face along z. Reaction:
/// elastic force along z at the far face, positive in tension. Volume over that at rest. Energies belong together: in
/// free undamped motion their sum is constant to rounding (kinetic at the last half step, strain across it; at finite
/// strain at its end, so that the sum swings about a constant).
template <class F>
struct BellyReport {
  F elongation_m, reaction_n, volume_ratio, kinetic_energy_j, strain_energy_j;
};

/// Run-time sized columns (three floats a node, node-major: x0 y0 z0 x1 …) of a table of one mesh template:
/// displacement from the rest position in m, and velocity in m/s (of ECD, ICD and finite half a step back), in the
/// muscle's frame.
struct NodalDisplacement {};
struct NodalVelocity {};

/// Run-time sized columns of modal bellies (systems/deformation/modal.h says what is in them): how their modes
/// move; what one individual's motions are like; and, only where someone looks, how its control points follow.
struct ModalState {
  static constexpr std::uint64_t stable_id = 0x62b37cecc8dc5c87;
};
struct ModalMotion {
  static constexpr std::uint64_t stable_id = 0x6d3aef306ec57708;
};
struct ModalShape {
  static constexpr std::uint64_t stable_id = 0xb61604878239759f;
};

/// Tags of muscle tables: the number of equal steps that a tick is cut into, of who steps explicitly, does so at finite
/// strain, solves, and settles to the static answer; modal bellies that show the static answer alone; and floats that
/// one block is worked on with.
struct Substeps {};
struct FiniteSteps {};
struct SolvedSteps {};
struct StaticSteps {};
struct ModalStatic {
  static constexpr std::uint64_t stable_id = 0x933122594e4ec4c0;
};
struct ModalTuned {
  static constexpr std::uint64_t stable_id = 0x7f0896c9b438a398;
};
struct ScratchFloats {};

/// What is counted (Tally) of bellies whose numbers were not finite at a tick's end, and which began anew.
struct RestartedBellies {};

}  // namespace mobil::inline v0_3
