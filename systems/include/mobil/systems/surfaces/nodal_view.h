#pragma once
// Read access to a muscle's control points.

#include <cstdint>

#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Nodal displacements of one muscle within its block. Component c of node n, m, is at first[(3·n + c)·16].
struct NodalView {
  const float* first = nullptr;
  std::uint32_t nodes = 0;
};

/// Returns the displayed displacements of a muscle's control points, in its frame, including fades after changes of
/// method. `first` is null for a stale handle or without control points. Valid until the next structural change.
NodalView nodal_displacement(const World& world, Entity muscle);

}  // namespace mobil::inline v0_3
