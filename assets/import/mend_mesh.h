#pragma once
// Repairs of frequent faults of mesh files without moving a vertex: doubled triangles, mixed winding, vertices where
// two surfaces touch, small holes. Every function returns how much it changed; meshes are in any unit.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <mobil/components/surface.h>
#include "assets/import/mesh_pieces.h"

namespace mobil::inline v0_3 {

/// Removes triangles that have the same corners as an earlier one, where more than two triangles use one of their
/// edges. Returns their number.
std::size_t drop_doubled(SurfaceMesh& mesh);

/// Winds the triangles of each piece alike by turning the fewer ones. Returns the number turned, or nothing if a
/// surface has only one side or an edge has more than two triangles.
std::optional<std::size_t> wind_alike(SurfaceMesh& mesh);

/// Gives each fan of triangles about a vertex a separate vertex. Triangles must be wound alike. Returns the number of
/// vertices that had more than one fan.
std::size_t split_pinches(SurfaceMesh& mesh);

/// Loops of open edges, closed and left, and the share of the surface that closes them.
struct ClosedHoles {
  std::size_t closed = 0, left = 0;
  double share = 0;
};

/// Closes each loop of open edges by a fan about its middle, if that takes at most `each` of the surface's area, and
/// all of them at most `all`. Triangles must be wound alike, and no vertex pinched.
ClosedHoles close_holes(SurfaceMesh& mesh, double each, double all);

/// Turns pieces that enclose a negative volume, except those in the hollow of another. The surface must be closed.
/// Returns their number.
std::size_t turn_outwards(SurfaceMesh& mesh, const Pieces& pieces);

/// Returns how often the other pieces wind round the first vertex of `piece`: 0 outside of all, 1 inside of one.
double times_inside_others(const SurfaceMesh& mesh, const Pieces& pieces, std::uint32_t piece);

}  // namespace mobil::inline v0_3
