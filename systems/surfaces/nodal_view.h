#pragma once
// Where a muscle's control points are.

#include <cstdint>

#include "engine/world.h"

namespace mobil {

/// One individual's nodal displacement within its block: component c of node n (m) at first[(3·n + c)·16].
struct NodalView {
  const float* first = nullptr;
  std::uint32_t nodes = 0;
};

/// A muscle's control points where they are now, in its frame, as they are to be shown (what fades after a change of
/// method included); `first` is null for a stale handle and where there are none. Until the next change of structure.
NodalView nodal_displacement(const World& world, Entity muscle);

}  // namespace mobil
