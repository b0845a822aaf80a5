#pragma once
// Placement of a muscle's surface by its mesh and its bones.

#include <mobil/systems/surfaces/packed_surface.h>

namespace mobil::inline v0_3 {

/// Writes positions of a surface's vertices. With T the motion of a bone since rest,
///   p = lattice · frame(belly · rest_in_lattice + Σ wᵢ uᵢ) + origin · T_origin(p₀) + insertion · T_insertion(p₀).
/// `node`: displacements uᵢ (m, in the muscle's frame), x y z of one node after the other, surface.nodes of them. A
/// left muscle's surface is computed in the mirror image and reflected. `places`: x y z x of one place after the
/// other, 4 · surface.places() floats, 16-byte aligned. Bits are the same on every instruction set.
void place_vertices(const PackedSurface& surface, const SkinMaps& maps, const float* node, Side side, float* places);

}  // namespace mobil::inline v0_3
