#pragma once
// The edges of a mesh, each with the triangles that use it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Edge e of a mesh goes from corner e to the next corner of the same triangle. `ends` is the same for both orders of
/// its two vertices.
struct MeshEdge {
  std::uint64_t ends;
  std::uint32_t edge;
};

/// Returns the corner after `e` in its triangle; corners 3t to 3t + 2 are those of triangle t.
inline std::uint32_t next_corner(std::uint32_t e) {
  return e % 3 == 2 ? e - 2 : e + 1;
}

/// Returns the edges by ends, then by number.
std::vector<MeshEdge> sorted_edges(const SurfaceMesh& mesh);

/// Calls `use(first, last)` with each run of edges between the same two vertices.
template <class Use>
void each_edge(const std::vector<MeshEdge>& sorted, Use use) {
  for (std::size_t i = 0, j = 0; i < sorted.size(); i = j) {
    while (j < sorted.size() && sorted[j].ends == sorted[i].ends) ++j;
    use(i, j);
  }
}

/// Counts of edges that one triangle uses (a border), or more than two (not a surface).
struct EdgeCount {
  std::size_t border = 0, overused = 0;
};
EdgeCount count_edges(const SurfaceMesh& mesh);

}  // namespace mobil::inline v0_3
