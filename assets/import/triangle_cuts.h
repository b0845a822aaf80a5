#pragma once
// Self-intersections of a surface.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Pairs of triangles without a common vertex that cut each other: all of them, and those of two different pieces.
/// Triangles that touch or are coplanar do not count.
struct CutCount {
  std::size_t pairs = 0, between_pieces = 0;
  bool complete = true;  // false: the search ended early, and there can be more
};

/// Counts the pairs. `piece` has a number for each triangle; see label_pieces. The search ends at `max_pairs`, or after
/// a number of box comparisons that only a tangle needs.
CutCount count_cuts(const SurfaceMesh& mesh, std::span<const std::uint32_t> piece, std::size_t max_pairs = 100'000);

}  // namespace mobil::inline v0_3
