#pragma once
// A bound surface in the layout of the kernels: vertices of one hexahedron are adjacent, eight in a block, so that its
// nodes are read once for all of them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/texture_places.h>
#include <mobil/components/body.h>
#include <mobil/components/surface.h>
#include <mobil/engine/error.h>
#include <mobil/systems/surfaces/skin_pose.h>
#include <mobil/systems/surfaces/vertex_rings.h>

namespace mobil::inline v0_3 {

/// Vertices in a block.
inline constexpr std::size_t block_vertices = 8;
struct alignas(32) Eight {
  float lane[block_vertices];
};

/// Vertices that follow a hexahedron: trilinear weights of its nodes, and positions in the muscle's rest frame, m.
struct LatticeBlock {
  Eight node_weight[8];
  Vec3<Eight> rest_in_lattice;
};

/// Vertices that follow bones: positions in the standing body, m, and weights with the sum 1.
struct BoneBlock {
  Vec3<Eight> rest;
  Eight origin, insertion, lattice;
};

/// Shares of the bones that hold vertices rigidly, in addition to those of their BoneBlock.
struct HeldBlock {
  Eight origin, insertion;
};

/// A muscle's surface. Blocks are stored in four groups: those of the lattice alone, of lattice and bones, of bones
/// alone, and of bones that hold them. The first two groups have a LatticeBlock and nodes, the others a BoneBlock, and
/// the last one a HeldBlock. Unused lanes repeat a vertex. A vertex' place is its index among all lanes.
struct PackedSurface {
  SurfaceRest rest;
  std::uint32_t nodes = 0;              // of the lattice
  std::size_t lattice_only_blocks = 0;  // of `lattice`
  std::vector<std::array<std::uint16_t, 8>> node;
  std::vector<LatticeBlock> lattice;
  std::vector<BoneBlock> bone;
  std::vector<HeldBlock> held;   // of the last blocks of `bone`
  std::size_t fixed_blocks = 0;  // the last ones of these, whose vertices are held whole
  VertexRings rings;
  std::vector<PlacedAlong> along;  // by vertex; empty: no tangents

  std::size_t vertices() const { return rings.vertex.size(); }
  std::size_t places() const { return block_vertices * (lattice_only_blocks + bone.size()); }
};

/// Packs a surface that is bound to a lattice of `nodes` nodes. `along` has one element for each vertex, or is empty.
/// Errors, with the surface's name: a surface that is not bound or has other nodes, a vertex index out of range, too
/// many vertices.
Result<PackedSurface> pack_surface(const MuscleSurface& surface, const Body& body, std::uint32_t nodes,
                                   std::span<const AlongStencil> along = {});

/// Vertices of a rigid surface, in their order, with normals at rest. Unused lanes repeat the last vertex.
struct RigidBlock {
  Vec3<Eight> rest, normal;
};
/// Direction along the surface at a vertex, at rest.
struct RigidAlong {
  Vec3<float> direction;
  float handed;
};
struct RigidSurface {
  std::size_t vertices = 0;
  std::vector<RigidBlock> block;
  std::vector<RigidAlong> along;  // by vertex; empty: no tangents
};

/// Packs a rigid surface. Errors: a vertex index out of range.
Result<RigidSurface> pack_rigid(const SurfaceMesh& mesh, std::span<const AlongStencil> along = {});

}  // namespace mobil::inline v0_3
