#pragma once
// A muscle's surface where its mesh and its bones are now.

#include <mobil/systems/surfaces/packed_surface.h>

namespace mobil::inline v0_3 {

/// Positions of a surface's vertices: with T the motion of a bone since rest,
///   p = lattice · frame(belly · rest_in_lattice + Σ wᵢ uᵢ) + origin · T_origin(p₀) + insertion · T_insertion(p₀).
/// `node`: displacements uᵢ (m, in the muscle's frame), x y z of one node after the other, surface.nodes of them. A
/// left muscle's surface is computed in the mirror image and reflected. `places`: x y z x of one place after the
/// other, 4 · surface.places() floats, 16-byte aligned. The same bits on every instruction set.
void place_vertices(const PackedSurface& surface, const SkinMaps& maps, const float* node, Side side, float* places);

}  // namespace mobil::inline v0_3
