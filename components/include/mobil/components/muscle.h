#pragma once
// Components of one leg muscle: owner, scale, line of action, moving nodes. Mechanics: a linear elastic belly in the
// frame of its line of action, z from origin to insertion. A left muscle is solved as a right one and mirrored for
// drawing.

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// A muscle of the table (mobil/muscle_table.h): a group of muscles that act alike, or a single muscle. The first four
/// are the default choice. Numbers are stable; new muscles are added at the end.
enum class Muscle : std::uint8_t {
  // groups
  hamstrings,
  quadriceps,
  triceps_surae,
  tibialis_anterior,
  // their members
  semimembranosus,
  semitendinosus,
  biceps_femoris_long_head,
  biceps_femoris_short_head,
  rectus_femoris,
  vastus_medialis,
  vastus_intermedius,
  vastus_lateralis,
  gastrocnemius_medial,
  gastrocnemius_lateral,
  soleus,
  plantaris,
  // groups
  gluteus_maximus,
  hip_abductors,
  iliopsoas,
  short_adductors,
  adductor_magnus,
  deep_calf,
  peroneals,
  toe_extensors,
  // their members
  gluteus_medius,
  gluteus_minimus,
  iliacus,
  psoas,
  pectineus,
  adductor_longus,
  adductor_brevis,
  tibialis_posterior,
  flexor_digitorum_longus,
  flexor_hallucis_longus,
  peroneus_longus,
  peroneus_brevis,
  extensor_digitorum_longus,
  extensor_hallucis_longus,
  peroneus_tertius,
  // single muscles of no group
  tensor_fasciae_latae,
  sartorius,
  gracilis,
  piriformis,
  quadratus_femoris,
  obturator_internus,
  obturator_externus,
  popliteus
};
inline constexpr std::size_t muscle_count = 47;
/// Number of muscles in the default choice.
inline constexpr std::size_t usual_muscle_count = 4;

/// A set of muscles, by number.
inline constexpr std::size_t max_muscles = 64;
using MuscleSet = std::bitset<max_muscles>;
/// Split a set into the bits of muscles 0 to 31 and those of the others, and join these.
inline void split_muscles(const MuscleSet& set, std::uint32_t& first, std::uint32_t& more) {
  first = static_cast<std::uint32_t>(set.to_ullong());
  more = static_cast<std::uint32_t>(set.to_ullong() >> 32U);
}
inline MuscleSet join_muscles(std::uint32_t first, std::uint32_t more) {
  return {first | std::uint64_t{more} << 32U};
}

/// Elements of a belly's mesh along x, y and z.
using Cells = std::array<std::uint32_t, 3>;

/// Linear elastic material. The defaults are the paper's (section 6.1).
struct Material {
  double density_kg_m3 = 1000.0;  ///< 1 to 1e6
  double young_pa = 1.06667e4;    ///< 1 to 1e12
  double poisson = 0.3333;        ///< -0.99 to 0.4999

  friend bool operator==(const Material&, const Material&) = default;
};

/// Stiffness integration of an eight-node hexahedron. `full`: 2×2×2 Gauss points. `bbar`: the same with the element's
/// mean dilatation (B-bar, for nearly incompressible tissue). `one_point`: one point, with added stiffness against the
/// hourglass modes that it leaves free.
enum class Element : std::uint8_t { full, bbar, one_point };
inline constexpr std::array<std::string_view, 3> element_name = {"full", "bbar", "one-point"};

/// Strain measure: small strains, K·u; or finite strain with active fibres (assets/fem/finite_kernel.h).
enum class Strain : std::uint8_t { small, finite };

/// Equation of motion of a belly (section 6.3 of the paper): K·u = f (statics); explicit central differences with the
/// lumped mass (ECD); implicit central differences with the consistent mass (ICD); Newmark average acceleration (CAA);
/// a few modes of a finer mesh, each integrated exactly (modal); the line of action alone (none); central differences
/// at finite strain, for close-ups (finite).
enum class Method : std::uint8_t { statics, explicit_central, implicit_central, newmark, modal, none, finite };
inline constexpr std::array<std::string_view, 7> method_name = {
    "static", "explicit-central", "implicit-central", "newmark", "modal", "none", "finite"};
inline constexpr Method last_method = Method::finite;

/// Mass matrix: lumped at the nodes (diagonal), or consistent with the shape functions.
enum class Mass : std::uint8_t { lumped, consistent };
inline constexpr std::array<std::string_view, 2> mass_name = {"lumped", "consistent"};

/// Source of a muscle's excitation. `none`: no activation, and the tendon does not stretch. `phase`: the phase of the
/// walker's gait cycle (assets/muscles/excitation_curves.h), or standing tone for standing and posed people. `host`:
/// Simulation::set_excitation. `moments`: the moments at the leg's joints (JointMoments), shared among its muscles at
/// minimum cost.
enum class ExcitationSource : std::uint8_t { none, phase, host, moments };
inline constexpr std::array<std::string_view, 4> excitation_source_name = {"none", "phase", "host", "moments"};

/// The person that a muscle belongs to: entity index and generation, and the side of the body.
template <class F>
struct MuscleOwner {
  UInt32<F> index, generation, side;
};

/// Scale of a belly relative to its template. x and y are S = `across` times the template's, z is l = `along` times it.
/// With r = S / l the stiffness is K = S·(A/r + B + r·C) and the lumped mass S²·l·M₁. A, B, C and M₁ are the template's
/// (assets/fem/stiffness_terms.h).
template <class F>
struct BellyScale {
  F across, along;
};

/// Line of action. `force_n` = −stiffness·(length − rest_length) is the visual force of a soft bar (equations 2 and 3
/// of the paper), not a physiological one. `rotation` and `start_m` map the muscle's frame to the world: its origin is
/// the origin-side end of the belly's straight span, z along it. A left muscle has the mirror image's frame.
template <class F>
struct LineOfAction {
  F length_m, rest_length_m;
  F stiffness_n_per_m, force_n;
  Vec3<F> start_m;
  Quat<F> rotation;
};

/// Motion of a line of action: the rate of its length over the last tick, m/s, and its moment arms −∂L/∂θ, m. They
/// refer to hip and knee flexion and ankle dorsiflexion, positive where the muscle flexes. In a group they are means
/// over the members, weighted like the group's length. `length_m`: length at which the speed was taken, 0 before the
/// first.
template <class F>
struct LineMotion {
  F length_m, speed_m_s;
  F hip_flexion_arm_m, knee_flexion_arm_m, ankle_dorsiflexion_arm_m;
};

/// Boundary condition at the insertion face of a belly; the origin face is always fixed. `held`: all displacements are
/// prescribed. `sliding`: fixed sideways, free along z. `free`: free in all directions. As a tag (TagValue<FarEnd>) it
/// defines the meaning of the table's EndDrive.
enum class FarEnd : std::uint8_t { held, sliding, free };

/// Drive of the far end along z at the tick's start and end: displacement, m, if it is `held`; total force along +z, N,
/// if it is `sliding`.
template <class F>
struct EndDrive {
  F from, to;
};

/// Load of a free far end at the tick's start and end: total of a uniform traction over it, N.
template <class F>
struct EndTraction {
  Vec3<F> from_n, to_n;
};

/// Rows of a 3×3 matrix.
template <class F>
struct Mat3 {
  Vec3<F> x, y, z;
};

/// Load of gravity and of the frame's motion. At the tick's start and end, a mass at rest position x (m, in the
/// muscle's frame) is accelerated by `constant` + `gradient`·x, m/s² and 1/s². In a frame with acceleration a, angular
/// velocity ω and angular acceleration α, constant = g − a and gradient·x = −α×x − ω×(ω×x).
template <class F>
struct FrameLoad {
  Vec3<F> constant_from, constant_to;
  Mat3<F> gradient_from, gradient_to;
};

/// Frame of a muscle at the last tick and its change since the previous one: origin, m; displacement of the origin, m;
/// rotation; rotation vector in the world, rad. `known`: 0 nothing, 1 origin and rotation, 2 all.
template <class F>
struct FrameHistory {
  Vec3<F> start_m, step_m;
  Quat<F> rotation;
  Vec3<F> turn_rad;
  UInt32<F> known;
};

/// Result of a belly, written once a tick. Elongation: mean displacement of the far face along z. Reaction: elastic
/// force along z at the far face, positive in tension. Volume is relative to rest. The energies' sum is constant to
/// rounding in free undamped motion: kinetic at the last half step, strain across it. At finite strain the strain
/// energy is that at the step's end, so that the sum oscillates about a constant.
template <class F>
struct BellyReport {
  F elongation_m, reaction_n, volume_ratio, kinetic_energy_j, strain_energy_j;
};

/// Run-time sized columns of a table with one mesh template, three floats a node, node-major (x0 y0 z0 x1 …), in the
/// muscle's frame. Displacement from the rest position in m; velocity in m/s, for ECD, ICD and finite half a step
/// earlier.
struct NodalDisplacement {};
struct NodalVelocity {};

/// Run-time sized columns of modal bellies (systems/deformation/modal.h defines their contents): the state of the
/// modes; an individual's constants of motion; and, only with control points, the map from modes to control points.
struct ModalState {
  static constexpr std::uint64_t stable_id = 0x62b37cecc8dc5c87;
};
struct ModalMotion {
  static constexpr std::uint64_t stable_id = 0x6d3aef306ec57708;
};
struct ModalShape {
  static constexpr std::uint64_t stable_id = 0xb61604878239759f;
};

/// Tags of muscle tables. Number of equal steps a tick: explicit (Substeps), at finite strain, implicit (SolvedSteps)
/// and static. Modal bellies that show the static solution only, and those stiffened by activation. Scratch floats for
/// one block.
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

/// Tally of bellies whose values were not finite at a tick's end and which were therefore restarted.
struct RestartedBellies {};

}  // namespace mobil::inline v0_3
