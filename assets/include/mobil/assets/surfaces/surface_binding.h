#pragma once
// How a surface's vertices come to follow a deforming lattice and two bones.

#include <array>

#include <mobil/assets/fem/hexahedral_mesh.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Where a point lies in a lattice: in which eight nodes' element, and their trilinear weights (not negative, sum 1).
struct LatticePlace {
  Hexahedron node;
  std::array<double, 8> weight;
};

/// The place of `point` (m, the lattice's frame). Outside the lattice the parameters stop at its boundary, so the place
/// never extrapolates. Newton's method on the trilinear map, the layer along z first; exact inside a lattice whose
/// elements are not inverted.
LatticePlace place_in_lattice(const HexahedralMesh& lattice, const Vec3<double>& point);

/// The muscle's frame when the body stands: the belly's origin-side end (m, world) and its rotation, z along the belly.
struct RestFrame {
  Vec3<float> start_m;
  Quat<float> rotation;
};

/// Heights over the lattice's origin face (m, along z, ascending) between which a surface passes from the bone of
/// origin to the lattice, and from the lattice to the bone of insertion.
struct Passages {
  double origin_to, origin_from, insertion_from, insertion_to;
};

/// Fills `binding` and `rest_in_lattice` of a surface in the standing body's world axes. The lattice is this
/// individual's own, in the muscle's frame. Weights are smooth in z (C¹). LodRequest a lattice of at most 65,536 nodes,
/// and passages that ascend.
void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                  const Passages& passages);

/// The same with passages of `blend_m` right beyond the lattice's end faces, for a surface on its own.
void bind_surface(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame, double blend_m);

/// Where a muscle is attached to its bones (m, world, the body standing): where its surface ends, or farther out where
/// it goes on in a tendon with a surface of its own.
struct Attachments {
  Vec3<float> origin_m, insertion_m;
};

/// Binds a surface to the lattice that drives it and to its bones. Between the lattice's end faces it follows the
/// lattice alone; beyond them it passes to its bones as far as its attachments, so that a joint on the way bends it
/// smoothly. A passage is `min_m` long at least (0.04 m looks right for a body of 1.80 m), and the longer the thicker
/// the surface is there, lest a joint fold it: for that, it begins inside the lattice. Its ends turn in part as the
/// belly does and in part as their bones, for a tendon bends where it comes off a bone. Returns where it passes.
Passages bind_muscle(MuscleSurface& surface, const HexahedralMesh& lattice, const RestFrame& frame,
                     const Attachments& attachments, double min_m);

/// Binds what goes on beyond the insertion of a bound surface to another bone, as quadriceps over the kneecap to the
/// tibia: up to `ligament.origin_m` exactly as the surface itself, from there smoothly to that bone at
/// `ligament.insertion_m`. `passages`: the surface's own.
void bind_beyond(MuscleSurface& beyond, const MuscleSurface& surface, const HexahedralMesh& lattice,
                 const RestFrame& frame, const Passages& passages, const Attachments& ligament);

/// Binds a surface to its two bones alone: smoothly from the origin at `origin_m` to the insertion at `insertion_m` (m,
/// world, the body standing; not the same point), by place along the line between them.
void bind_ligament(MuscleSurface& surface, const Vec3<float>& origin_m, const Vec3<float>& insertion_m);

}  // namespace mobil::inline v0_3
