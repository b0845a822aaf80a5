#pragma once
// Explicit central differences at finite strain: sixteen bellies of one template at once, element by element, each lane
// with its own size. assets/fem/finite_kernel.h describes the tissue.

#include <cstdint>

#include <mobil/components/lanes.h>
#include "systems/deformation/deformation.h"

namespace mobil::inline v0_3 {

/// Advances a block by one tick in `substeps` equal steps, each within `muscle.critical_steps` of a template of
/// Strain::finite.
///
///   v½ = keep·v₋½ + Δt'·(field − ω²·ū) − Δt'·M⁻¹·f(u),   u ← u + Δt·v½,   Δt' = Δt/(1 + αΔt/2).
///
/// ū is the mean sideways displacement of the node's plane: fascia holds sections, which bulge freely. A substep is one
/// sweep from origin to insertion. A plane of nodes moves as soon as the elements on both sides have read it, so only
/// the forces of two planes are stored.
///
/// `activation` (0–1) can be null for a relaxed belly, damped as in the template. Otherwise the damping is that of
/// tuned bellies (tuned_damping_per_s). `block.stiffness` is ignored, because sizes cost nothing here. Fibres pull
/// about the belly's stretch at the tick's end (held) or start.
///
/// Report: strain energy includes tissue, hourglass stiffness and the work that fibres would return at this activation,
/// all at the tick's end. It is 0 at rest except for rounding. Kinetic energy is half a step back. Reaction is the
/// elastic force at the tick's end. A lane's NaN stays in its lane. Uses no heap. `scratch`: scratch_floats(muscle,
/// Method::finite).
void deform_finite(const BellyBlock& block, const FarFaceDrive& end, const Lanes<float>* activation,
                   std::uint32_t substeps, float tick_s, float* scratch);

}  // namespace mobil::inline v0_3
