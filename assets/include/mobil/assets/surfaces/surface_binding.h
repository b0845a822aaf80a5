#pragma once
// Binding of a surface's vertices to a deforming lattice and two bones.

#include <array>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Position of a point in a lattice: eight nodes of its element, and their trilinear weights (not negative, sum 1).
struct LatticePlace {
  Hexahedron node;
  std::array<double, 8> weight;
};

/// Returns the place of `point` (m, the lattice's frame). Outside the lattice the parameters stop at its boundary, so
/// the place never extrapolates. Newton's method on the trilinear map starts with the layer along z; it is exact inside
/// a lattice without inverted elements.
LatticePlace place_in_lattice(const HexahedralMesh& lattice, const Vec3<double>& point);

/// The muscle's frame in the standing body: the belly's origin-side end (m, world) and its rotation, z along the belly.
struct RestFrame {
  Vec3<float> start_m;
  Quat<float> rotation;
};

/// Heights above the lattice's origin face (m, along z, ascending) between which a surface passes from the bone of
/// origin to the lattice, and from the lattice to the bone of insertion.
struct Passages {
  double origin_to, origin_from, insertion_from, insertion_to;
};

/// Fills `binding` and `rest_in_lattice` of a surface in the standing body's world axes. The lattice is this person's
/// own, in the muscle's frame. Weights are smooth in z (C¹). Requires a lattice of at most 65,536 nodes, and passages
/// that ascend.
void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                  const Passages& passages);

/// Binds a single surface, with passages of `blend_m` directly beyond the lattice's end faces.
void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame, double blend_m);

/// Attachments of a muscle to its bones (m, world, the body standing). They are the ends of its surface, or farther out
/// if a tendon with its own surface continues it.
struct Attachments {
  Vec3<float> origin_m, insertion_m;
};

/// Binds a surface to the lattice that drives it and to its bones. Between the lattice's end faces it follows only the
/// lattice. Beyond them it passes to its bones up to its attachments, so that a joint in between bends it smoothly. A
/// passage is at least `min_m` long (0.04 m looks right for a body of 1.80 m). A thicker surface has a longer one,
/// which starts inside the lattice, so that a joint does not fold it. The ends turn partly with the belly and partly
/// with their bones, because a tendon bends where it leaves a bone. Returns the passages.
Passages bind_muscle(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                     const Attachments& attachments, double min_m);

/// Binds the continuation of a bound surface beyond its insertion to another bone, such as quadriceps over the kneecap
/// to the tibia. Up to `ligament.origin_m` it follows the surface exactly, from there it passes smoothly to that bone
/// at `ligament.insertion_m`. `passages` are the surface's own.
void bind_beyond(MuscleSurface& beyond, const MuscleSurface& surface, const HexahedralMesh& lattice,
                 const RestFrame& frame, const Passages& passages, const Attachments& ligament);

/// Binds a surface only to its two bones: smoothly from the origin at `origin_m` to the insertion at `insertion_m` (m,
/// world, the body standing; not the same point), by position along the line between them.
void bind_ligament(MuscleSurface& surface, const Vec3<float>& origin_m, const Vec3<float>& insertion_m);

}  // namespace mobil::inline v0_3
