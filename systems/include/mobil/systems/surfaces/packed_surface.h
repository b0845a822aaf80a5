#pragma once
// A bound surface as the kernels read it: vertices of one hexahedron side by side, eight in a block, so that its nodes
// are read once for all of them.

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

/// Vertices a block.
inline constexpr std::size_t block_vertices = 8;
struct alignas(32) Eight {
  float lane[block_vertices];
};

/// What vertices of one hexahedron take from its nodes: trilinear weights, and the vertex in the muscle's rest frame.
struct LatticeBlock {
  Eight node_weight[8];
  Vec3<Eight> rest_in_lattice;
};

/// What they take from their bones: the vertex in the standing body, and shares (sum 1).
struct BoneBlock {
  Vec3<Eight> rest;
  Eight origin, insertion, lattice;
};

/// A muscle's surface. Blocks lie in this order: those of the lattice alone, those of lattice and bones, those of bones
/// alone; the first two kinds have a LatticeBlock and nodes, the last two a BoneBlock. Lanes left over repeat a vertex.
/// A vertex' place is its number among all lanes.
struct PackedSurface {
  SurfaceRest rest;
  std::uint32_t nodes = 0;              // of the lattice
  std::size_t lattice_only_blocks = 0;  // of `lattice`
  std::vector<std::array<std::uint16_t, 8>> node;
  std::vector<LatticeBlock> lattice;
  std::vector<BoneBlock> bone;
  VertexRings rings;
  std::vector<PlacedAlong> along;  // by vertex; empty: no tangents

  std::size_t vertices() const { return rings.vertex.size(); }
  std::size_t places() const { return block_vertices * (lattice_only_blocks + bone.size()); }
};

/// Packs a surface that is bound to a lattice of `nodes` nodes; `along`: of each vertex, or nothing. Errors, in one
/// line that names the surface: not bound, or to other nodes; triangles of vertices that are not there; too many
/// vertices.
Result<PackedSurface> pack_surface(const MuscleSurface& surface, const Body& body, std::uint32_t nodes,
                                   std::span<const AlongStencil> along = {});

/// A surface that moves as one rigid piece, in order, with its normals at rest. Lanes left over repeat the last vertex.
struct RigidBlock {
  Vec3<Eight> rest, normal;
};
/// A vertex' direction along the surface at rest.
struct RigidAlong {
  Vec3<float> direction;
  float handed;
};
struct RigidSurface {
  std::size_t vertices = 0;
  std::vector<RigidBlock> block;
  std::vector<RigidAlong> along;  // by vertex; empty: no tangents
};

/// Errors: triangles of vertices that are not there.
Result<RigidSurface> pack_rigid(const SurfaceMesh& mesh, std::span<const AlongStencil> along = {});

}  // namespace mobil::inline v0_3
