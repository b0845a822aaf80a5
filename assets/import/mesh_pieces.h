#pragma once
// Pieces of a mesh that are connected by their vertices.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/components/surface.h>
#include "assets/surfaces/surface_mesh.h"

namespace mobil::inline v0_3 {

/// A number for each triangle, from 0, the same within a connected piece.
struct Pieces {
  std::vector<std::uint32_t> of;  // each triangle's
  std::uint32_t count = 0;
};
Pieces label_pieces(const SurfaceMesh& mesh);

/// Returns the number of triangles in each piece.
std::vector<std::size_t> piece_triangles(const Pieces& pieces);

/// Returns the volume that each piece encloses, in the cube of the mesh's unit; negative if it is wound inwards.
std::vector<double> piece_volumes(const SurfaceMesh& mesh, const Pieces& pieces);

/// Keeps the triangles of the pieces whose number satisfies `stays`, and the vertices that they use.
template <class Stays>
void keep_pieces(SurfaceMesh& mesh, const Pieces& pieces, Stays stays) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < pieces.of.size(); ++t) {
    if (!stays(pieces.of[t])) continue;
    for (std::size_t c = 0; c < 3; ++c) mesh.triangle[kept++] = mesh.triangle[3 * t + c];
  }
  mesh.triangle.resize(kept);
  drop_unused(mesh);
}

}  // namespace mobil::inline v0_3
