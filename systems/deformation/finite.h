#pragma once
// Central differences at finite strain: sixteen bellies of one template at once, element by element, each lane of its
// own size. What is stepped: assets/fem/finite_kernel.h.
//   v½ = keep·v₋½ + Δt'·(field − ω²·ū) − Δt'·M⁻¹·f(u),   u ← u + Δt·v½,   Δt' = Δt/(1 + αΔt/2)
// ū is the mean displacement sideways of the node's plane: fascia holds sections, which bulge freely.
// A substep is one sweep from origin to insertion: a plane of nodes moves as soon as the elements on either side have
// read it, so that forces are kept of two planes alone.

#include <cstdint>

#include <mobil/components/lanes.h>
#include "systems/deformation/deformation.h"

namespace mobil::inline v0_3 {

/// One tick of a block in `substeps` equal steps, each within `muscle.critical_steps` of a template of Strain::finite.
/// `activation` (0–1) may be null: relaxed, and damped as the template says; with it damping is that of tuned bellies
/// (tuned_damping_per_s). `block.stiffness` has no part: sizes cost nothing here. Fibres pull about the stretch that
/// the belly has at the tick's end (held), or had at its start.
///
/// Report: strain energy is that of tissue and hourglass stiffness, and what fibres would give back at this activation,
/// all at the tick's end, 0 at rest but for rounding; kinetic energy is half a step back; reaction is the elastic force
/// at the tick's end. A lane's NaN stays in its lane. No heap. `scratch`: scratch_floats(muscle, Method::finite).
void deform_finite(const BellyBlock& block, const FarFaceDrive& end, const Lanes<float>* activation,
                   std::uint32_t substeps, float tick_s, float* scratch);

}  // namespace mobil::inline v0_3
