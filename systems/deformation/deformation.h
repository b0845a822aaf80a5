#pragma once
// How bellies move: linear elasticity in the frame of the line of action, sixteen individuals a block, by the method of
// their table. Explicit central differences (ECD), per substep Δt = tick / n, from displacement uₙ and half-step
// velocity vₙ₋½ (mass damping α treated implicitly, stiffness damping β with the last velocity):
//   vₙ₊½ = [(1 − αΔt/2)·vₙ₋½ + Δt·M⁻¹·(f(tₙ) − K·(uₙ + β·vₙ₋½))] / (1 + αΔt/2),   uₙ₊₁ = uₙ + Δt·vₙ₊½
// (equations 4 and 5 of the paper; Hughes, The Finite Element Method, 1987, chapter 9). ICD is the same with the
// consistent mass. CAA, Newmark's β = 1/4 and γ = 1/2, solves for the mean velocity w of the step,
//   [(2/Δt + α)·M + (Δt/2 + β)·K]·w = (fₙ + fₙ₊₁)/2 + (2/Δt)·M·vₙ − K·uₙ,   uₙ₊₁ = uₙ + Δt·w,   vₙ₊₁ = 2w − vₙ.
// Static: K·u = f. ECD and ICD are stable while Δt stays under the individual's critical step: choose n with
// `substeps_within`; CAA always is, for bellies of about the size that its solver was made for.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/muscle.h>
#include "assets/fem/muscle_template.h"

namespace mobil::inline v0_3 {

struct BellySolver;  // assets/fem/belly_solver.h

/// Whose stiffness a block of bellies has: each lane that of its own scales, or every lane the template's own (then
/// S = l = 1 must hold in all lanes; three quarters of the arithmetic). A property of a table, not of a lane's values.
enum class Stiffness : std::uint8_t { individual, shared };

/// What drives the far face of a block this tick, linear from its start to its end, in the way that the template was
/// made for:
/// - FarEnd::held: held sideways, moving along z by EndDrive's displacement;
/// - FarEnd::sliding: held sideways, pulled along z by a uniform traction whose total is EndDrive's force;
/// - FarEnd::free: loaded by a uniform traction whose total is EndTraction's.
struct FarFaceDrive {
  FarEnd way;
  const Lanes<float>*from[3], *to[3];  // per axis; null: none

  /// `held_or_sliding`: as it says.
  FarFaceDrive(FarEnd held_or_sliding, const EndDrive<Lanes<float>>& end)
      : way(held_or_sliding), from{nullptr, nullptr, &end.from}, to{nullptr, nullptr, &end.to} {}
  FarFaceDrive(const EndTraction<Lanes<float>>& end)
      : way(FarEnd::free),
        from{&end.from_n.x, &end.from_n.y, &end.from_n.z},
        to{&end.to_n.x, &end.to_n.y, &end.to_n.z} {}
};

/// Sixteen bellies of one template.
///
/// `displacement` (from rest, m) and `velocity` (m/s; of ECD, ICD and finite half a step back; unused by static) hold
/// `nodal_width(cells)` × 16 floats each in the muscle's frame, node-major (x0 y0 z0 x1 …), sixteen lanes at each,
/// aligned to 64 bytes. All zero is a belly at rest; the origin face's are never touched.
struct BellyBlock {
  const MuscleTemplate& muscle;
  const BellyScale<Lanes<float>>& scale;
  float *displacement, *velocity;
  BellyReport<Lanes<float>>& report;
  Stiffness stiffness = Stiffness::individual;
  const FrameLoad<Lanes<float>>* frame = nullptr;  // null: the frame is at rest and weightless, and costs nothing
  bool reported = true;                            // whether `report` is written; of 81 nodes it costs half a substep
};

/// Floats of scratch memory (aligned to 64 bytes) that one block takes while it is worked on: by ECD only with
/// stiffness damping, by finite forces of two planes of nodes and the mean of each plane.
std::size_t scratch_floats(const MuscleTemplate& muscle, Method method);

/// One tick of a block by ECD in `substeps` equal steps. A lane's NaN stays in its lane. No heap, no state of its own.
void deform_explicit(const BellyBlock& block, const FarFaceDrive& end, std::uint32_t substeps, float tick_s,
                     float* scratch = nullptr);

/// The same by the method of `solver`, which was made for the template, its bellies' size and this substep; static
/// takes the load at the tick's end, whatever `substeps` says.
void deform_implicit(const BellyBlock& block, const BellySolver& solver, const FarFaceDrive& end,
                     std::uint32_t substeps, float tick_s, float* scratch);

}  // namespace mobil::inline v0_3
