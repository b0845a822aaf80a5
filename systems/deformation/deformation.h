#pragma once
// How bellies move: explicit central differences on linear elasticity, sixteen individuals a block.
//
// Each substep Δt = tick / n, from displacement uₙ and half-step velocity vₙ₋½ (damping α treated implicitly):
//   vₙ₊½ = [(1 − αΔt/2)·vₙ₋½ + Δt·M⁻¹·(f(tₙ) − K·uₙ)] / (1 + αΔt/2),   uₙ₊₁ = uₙ + Δt·vₙ₊½
// (equations 4 and 5 of the paper with its explicit central differences; Hughes, The Finite Element Method, 1987,
// section 9.3). Stable while Δt stays under the individual's critical step: choose n with `substeps_within`.

#include <cstdint>

#include "assets/muscle_template.h"
#include "components/lanes.h"
#include "components/muscle.h"

namespace mobil {

/// Whose stiffness a block of bellies has: each lane that of its own scales, or every lane the template's own (then
/// S = l = 1 must hold in all lanes; three quarters of the arithmetic). A property of a table, not of a lane's values.
enum class Stiffness : std::uint8_t { individual, shared };

/// One tick of a block, the far face driven by `end`, in the way that the template was made for:
/// - EndDisplacement (FarEnd::held): held sideways, moving along z from `from_m` to `to_m`;
/// - EndForce (FarEnd::sliding): held sideways, pulled along z by a uniform traction of that total;
/// - EndTraction (FarEnd::free): loaded by a uniform traction of that total;
/// each linear over the tick.
///
/// `displacement` (from rest, m) and `velocity` (m/s, at the half step) hold `nodal_width(cells)` × 16 floats each in
/// the muscle's frame, node-major (x0 y0 z0 x1 …), sixteen lanes at each, aligned to 64 bytes. All zero is a belly at
/// rest; the origin face's are never touched. A lane's NaN stays in its lane. No heap, no state of its own.
void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndDisplacement<Lanes<float>>& end, float* displacement, float* velocity,
                     std::uint32_t substeps, float tick_s, BellyReport<Lanes<float>>& report,
                     Stiffness stiffness = Stiffness::individual);
void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndForce<Lanes<float>>& end, float* displacement, float* velocity, std::uint32_t substeps,
                     float tick_s, BellyReport<Lanes<float>>& report, Stiffness stiffness = Stiffness::individual);
void deform_explicit(const MuscleTemplate& muscle, const BellyScale<Lanes<float>>& scale,
                     const EndTraction<Lanes<float>>& end, float* displacement, float* velocity, std::uint32_t substeps,
                     float tick_s, BellyReport<Lanes<float>>& report, Stiffness stiffness = Stiffness::individual);

}  // namespace mobil
