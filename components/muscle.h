#pragma once
// A muscle group of one leg: whose it is, its size against its template, its line of action, its moving nodes.
// Mechanics: a linear elastic belly in the frame of its line of action, z from origin to insertion; a left muscle is
// solved as a right one and reflected when drawn.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "components/lanes.h"

namespace mobil {

enum class MuscleGroup : std::uint8_t { hamstrings, quadriceps, triceps_surae };
inline constexpr std::size_t muscle_group_count = 3;
inline constexpr std::array<std::string_view, muscle_group_count> muscle_group_name = {"hamstrings", "quadriceps",
                                                                                       "triceps_surae"};

/// Linear elastic material. The defaults are the paper's (section 6.1).
struct Material {
  double density_kg_m3 = 1000.0;
  double young_pa = 1.06667e4;
  double poisson = 0.3333;
};

/// The human a muscle belongs to: entity index and generation, and the side of the body.
template <class F>
struct MuscleOwner {
  Whole<F> index, generation, side;
};

/// Size of a belly against its template: x and y are S = `across` times the template's, z is l = `along` times it. With
/// r = S / l the stiffness is K = S·(A/r + B + r·C) and the lumped mass S²·l·M₁, where A, B, C and M₁ are the
/// template's (assets/stiffness_terms.h).
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

/// What drives the far end of the belly along z this tick: displacement at the tick's start and end, m.
template <class F>
struct EndDisplacement {
  F from_m, to_m;
};

/// What drives a far end held sideways and free along z: total force along +z at the tick's start and end, N.
template <class F>
struct EndForce {
  F from_n, to_n;
};

/// What loads a free far end: total of a uniform traction over it at the tick's start and end, N.
template <class F>
struct EndTraction {
  Vec3<F> from_n, to_n;
};

/// What a deforming belly did, written once a tick. Elongation: mean displacement of the far face along z. Reaction:
/// elastic force along z at the far face, positive in tension. Volume over that at rest. Energies belong together: in
/// free undamped motion their sum is constant to rounding (kinetic at the last half step, strain across it).
template <class F>
struct BellyReport {
  F elongation_m, reaction_n, volume_ratio, kinetic_energy_j, strain_energy_j;
};

/// Run-time sized columns (three floats a node, node-major: x0 y0 z0 x1 …) of a table of one mesh template:
/// displacement from the rest position in m, and velocity at the half step in m/s, in the muscle's frame.
struct NodalDisplacement {};
struct NodalVelocity {};

}  // namespace mobil
