#pragma once
// Numbers that the kernels of modal bellies take, of up to sixteen bodies, laid out as systems/deformation/modal.h
// says: word w of lane l at [16·w + l].

#include "assets/reduction/modal_bellies.h"

namespace mobil::inline v0_3 {

/// `motion`: modal_motion_width() words. Of tuned bellies neither damping nor tick is read: a tick makes both.
void write_motions(const ModalBellies& bellies, double damping_per_s, double tick_s, float* motion);
/// `shape`: modal_shape_width() words; the damping goes into the drag that is reported.
void write_shapes(const ModalBellies& bellies, double damping_per_s, float* shape);
/// Displacements of the control points at rest under the first input, of bellies that have no other.
void place_at_rest(const ModalBasis& basis, const ModalBellies& bellies, const Lanes<float>& input,
                   float* displacement);

}  // namespace mobil::inline v0_3
