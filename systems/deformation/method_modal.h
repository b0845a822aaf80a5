#pragma once
// Bellies that move along a few modes of a finer mesh, or show their static answer; and their control points and
// reports, only where these are asked for.

#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

extern const DeformationMethod modal_method;

/// Places control points that follow from a muscle's other columns, as the next tick will: of a muscle that has just
/// begun or changed, and of those in its block, whose bits stay. Nothing for other muscles. Takes no memory.
void place_now(World& world, Entity muscle);

}  // namespace mobil::inline v0_3
