#pragma once
// Deformation of bellies: linear elasticity in the frame of the line of action, sixteen individuals a block, by the
// method of their table. Modal bellies are in modal.h, finite strain is in finite.h.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

struct BellySolver;  // assets/fem/belly_solver.h

/// Stiffness of a block of bellies: each lane has its own scales, or all lanes the template's. `shared` requires S = l
/// = 1 in all lanes and takes 3/4 of the arithmetic. It belongs to a table, independent of a lane's values.
enum class Stiffness : std::uint8_t { individual, shared };

/// Drive of a block's far face during this tick, linear from start to end, as the template's far end is:
/// - FarEnd::held: held sideways, moving along z by EndDrive's displacement;
/// - FarEnd::sliding: held sideways, pulled along z by a uniform traction whose total is EndDrive's force;
/// - FarEnd::free: loaded by a uniform traction whose total is EndTraction's.
struct FarFaceDrive {
  FarEnd way;
  const Lanes<float>*from[3], *to[3];  // per axis; null: none

  /// Constructs the drive of a held or sliding end.
  FarFaceDrive(FarEnd held_or_sliding, const EndDrive<Lanes<float>>& end)
      : way(held_or_sliding), from{nullptr, nullptr, &end.from}, to{nullptr, nullptr, &end.to} {}
  FarFaceDrive(const EndTraction<Lanes<float>>& end)
      : way(FarEnd::free),
        from{&end.from_n.x, &end.from_n.y, &end.from_n.z},
        to{&end.to_n.x, &end.to_n.y, &end.to_n.z} {}
};

/// Sixteen bellies of one template.
///
/// `displacement` (from rest, m) and `velocity` (m/s) contain `nodal_width(cells)` × 16 floats each in the muscle's
/// frame: node-major (x0 y0 z0 x1 …), sixteen lanes per number, aligned to 64 bytes. Velocities of ECD, ICD and finite
/// are half a step back; static has none. All zero is a belly at rest. Values of the origin face are never written.
struct BellyBlock {
  const MuscleTemplate& muscle;
  const BellyScale<Lanes<float>>& scale;
  float *displacement, *velocity;
  BellyReport<Lanes<float>>& report;
  Stiffness stiffness = Stiffness::individual;
  const FrameLoad<Lanes<float>>* frame = nullptr;  // null: the frame is at rest and weightless, at no cost
  bool reported = true;                            // false skips `report`, which costs half a substep at 81 nodes
};

/// Returns the floats of scratch memory (aligned to 64 bytes) that one block needs while it is processed. ECD needs it
/// only with stiffness damping. Finite strain needs forces of two planes of nodes and the mean of each plane.
std::size_t scratch_floats(const MuscleTemplate& muscle, Method method);

/// Advances a block by one tick of ECD in `substeps` equal steps. Mass damping α is implicit, and stiffness damping β
/// uses the last velocity. With Δt = tick / n, displacement uₙ and half-step velocity vₙ₋½,
///
///   vₙ₊½ = [(1 − αΔt/2)·vₙ₋½ + Δt·M⁻¹·(f(tₙ) − K·(uₙ + β·vₙ₋½))] / (1 + αΔt/2),   uₙ₊₁ = uₙ + Δt·vₙ₊½.
///
/// (Equations 4 and 5 of the paper; Hughes, The Finite Element Method, 1987, chapter 9.) It is stable while Δt stays
/// under the individual's critical step: `substeps_within` chooses n. A lane's NaN stays in its lane. Uses no heap and
/// keeps no state.
void deform_explicit(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                     float* scratch = nullptr);

/// Advances a block by the method of `solver`, which was built for the template, about its bellies' size and this
/// substep. ICD uses the equations of ECD with the consistent mass, and also has a critical step. CAA (Newmark's β =
/// 1/4 and γ = 1/2) solves for the mean velocity w of the step,
///
///   [(2/Δt + α)·M + (Δt/2 + β)·K]·w = (fₙ + fₙ₊₁)/2 + (2/Δt)·M·vₙ − K·uₙ,   uₙ₊₁ = uₙ + Δt·w,   vₙ₊₁ = 2w − vₙ.
///
/// It is always stable for bellies of about the solver's size. Static solves K·u = f for the load at the tick's end and
/// ignores `substeps`.
void deform_implicit(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end,
                     std::uint32_t substeps, float tick_s, float* scratch);

}  // namespace mobil::inline v0_3
