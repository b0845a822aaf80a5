#pragma once
// Bellies that move along a few modes of a finer mesh, or are static, with control points and reports only on request.

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod modal_method;

/// Places the control points that follow from other columns, as the next tick will: those of a muscle that has just
/// begun or changed, and of its whole block, where the bits stay the same. Does nothing for other muscles. Allocates no
/// memory.
void place_now(World& world, Entity muscle);

}  // namespace mobil::inline v0_3
