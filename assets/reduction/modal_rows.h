#pragma once
// Numbers of up to sixteen bodies for the kernels of modal bellies, laid out as in systems/deformation/modal.h: word w
// of lane l at [16·w + l].

#include "assets/reduction/modal_bellies.h"

namespace mobil::inline v0_3 {

/// Writes modal_motion_width() words to `motion`. Tuned bellies ignore damping and tick, because a tick makes both.
void write_motions(const ModalBellies& bellies, double damping_per_s, double tick_s, float* motion);
/// Writes modal_shape_width() words to `shape`; the damping is part of the reported drag.
void write_shapes(const ModalBellies& bellies, double damping_per_s, float* shape);
/// Writes displacements of the control points at rest under the first input, of bellies without another.
void place_at_rest(const ModalBasis& basis, const ModalBellies& bellies, const Lanes<float>& input,
                   float* displacement);

}  // namespace mobil::inline v0_3
