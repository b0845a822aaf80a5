#pragma once
// What a mesh file often lacks, put right without moving a vertex: doubled triangles, mixed winding, vertices where two
// surfaces touch, small holes. Every function says how much it changed; meshes are in any unit.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <mobil/components/surface.h>
#include "assets/import/mesh_pieces.h"

namespace mobil::inline v0_3 {

/// Takes away triangles that have the same corners as another one before them, where more than two triangles use one
/// of their edges. Returns how many.
std::size_t drop_doubled(SurfaceMesh& mesh);

/// Winds the triangles of each piece alike; the fewer ones are turned. Returns how many were; nothing where a surface
/// has one side only, or an edge has more than two triangles.
std::optional<std::size_t> wind_alike(SurfaceMesh& mesh);

/// Gives each fan of triangles about a vertex a vertex of its own. Triangles must be wound alike. Returns how many
/// vertices belonged to more than one.
std::size_t split_pinches(SurfaceMesh& mesh);

/// Loops of open edges, and the share of the surface that closes all that was closed.
struct ClosedHoles {
  std::size_t closed = 0, left = 0;
  double share = 0;
};

/// Closes each loop of open edges by a fan about its middle, if that takes at most `each` of the surface's area, and
/// all of them at most `all`. Triangles must be wound alike, and no vertex pinched.
ClosedHoles close_holes(SurfaceMesh& mesh, double each, double all);

/// Turns pieces that enclose a negative volume, but for those that lie in the hollow of another. The surface must be
/// closed. Returns how many.
std::size_t turn_outwards(SurfaceMesh& mesh, const Pieces& pieces);

/// How often the pieces but number `piece` go round the first vertex of that piece: 0 outside of all, 1 inside of one.
double times_inside_others(const SurfaceMesh& mesh, const Pieces& pieces, std::uint32_t piece);

}  // namespace mobil::inline v0_3
