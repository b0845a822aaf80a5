#pragma once
// How a surface's vertices come to follow a deforming cage and two bones.

#include "assets/hexahedral_mesh.h"
#include "components/surface.h"

namespace mobil {

/// Where a point lies in a cage: in which eight nodes' element, and their trilinear weights (not negative, sum 1).
struct CagePlace {
  Hexahedron node;
  std::array<double, 8> weight;
};

/// The place of `point` (m, the cage's frame). Outside the cage the parameters stop at its boundary, so the place never
/// extrapolates. Newton's method on the trilinear map, the layer along z first; exact inside a cage whose elements are
/// not inverted.
CagePlace place_in_cage(const HexahedralMesh& cage, const Vec3<double>& point);

/// The muscle's frame when the body stands: the belly's origin-side end (m, world) and its rotation, z along the belly.
struct RestFrame {
  Vec3<float> start_m;
  Quat<float> rotation;
};

/// Fills `binding` and `rest_in_cage` of a surface in the standing body's world axes. The cage is this individual's
/// own, in the muscle's frame. Between the cage's end faces a vertex follows the cage alone; over `blend_m` beyond them
/// it passes smoothly to the bone of origin or of insertion. About 0.04 m for a body of 1.80 m looks right. Needs a
/// cage of at most 65,536 nodes and blend_m > 0.
void bind_surface(MuscleSurface& surface, const HexahedralMesh& cage, const RestFrame& frame, double blend_m);

/// Binds a surface to its two bones alone: smoothly from the origin at `origin_m` to the insertion at `insertion_m` (m,
/// world, the body standing; not the same point), by place along the line between them.
void bind_ligament(MuscleSurface& surface, const Vec3<float>& origin_m, const Vec3<float>& insertion_m);

}  // namespace mobil
