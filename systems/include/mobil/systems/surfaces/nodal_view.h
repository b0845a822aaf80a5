#pragma once
// Where a muscle's control points are.

#include <cstdint>

#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// One individual's nodal displacement within its block: component c of node n (m) at first[(3·n + c)·16].
struct NodalView {
  const float* first = nullptr;
  std::uint32_t nodes = 0;
};

/// A muscle's control points where they are now, in its frame, as they are to be shown (what fades after a change of
/// method included); `first` is null for a stale handle and where there are none. Until the next change of structure.
NodalView nodal_displacement(const World& world, Entity muscle);

}  // namespace mobil::inline v0_3
