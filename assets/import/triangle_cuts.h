#pragma once
// How often a surface cuts itself.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Pairs of triangles without a common vertex that cut each other, all of them and those of two different pieces.
/// Triangles that touch, or lie in one plane, do not count.
struct CutCount {
  std::size_t pairs = 0, between_pieces = 0;
  bool complete = true;  // false: the search ended early, and there may be more
};

/// `piece`: a number for each triangle; see label_pieces. The search ends at `max_pairs`, or after so many comparisons
/// of boxes that only a tangle needs them.
CutCount count_cuts(const SurfaceMesh& mesh, std::span<const std::uint32_t> piece, std::size_t max_pairs = 100'000);

}  // namespace mobil::inline v0_3
