#include <mobil/systems/surfaces/packed_surface.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include <mobil/engine/geometry.h>
#include <mobil/systems/surfaces/write_vertices.h>

namespace mobil::inline v0_3 {

using namespace geometry;

namespace {

enum class Follows : std::uint8_t { lattice, both, bones, held, fixed };

Follows follows(const VertexBinding& b) {
  if (const float held = b.origin_held + b.insertion_held; held > 0) return held < 1 ? Follows::held : Follows::fixed;
  if (b.lattice == 0) return Follows::bones;
  return b.lattice == 1 && b.origin == 0 && b.insertion == 0 ? Follows::lattice : Follows::both;
}

/// Vertices grouped by binding and by hexahedron, in the order of their blocks.
using Groups = std::map<std::tuple<Follows, std::array<std::uint16_t, 8>>, std::vector<std::uint32_t>>;

Groups grouped(const MuscleSurface& surface) {
  Groups groups;
  for (std::uint32_t v = 0; v < surface.binding.size(); ++v) {
    const VertexBinding& b = surface.binding[v];
    std::array<std::uint16_t, 8> node{};
    if (b.lattice != 0) std::copy_n(b.node, 8, node.begin());
    groups[{follows(b), node}].push_back(v);
  }
  return groups;
}

void set_lane(Vec3<Eight>& block, std::size_t lane, const Vec3<float>& value) {
  block.x.lane[lane] = value.x;
  block.y.lane[lane] = value.y;
  block.z.lane[lane] = value.z;
}

void set_lane(const MuscleSurface& surface, std::uint32_t v, std::size_t lane, LatticeBlock& block) {
  for (std::size_t i = 0; i < 8; ++i) block.node_weight[i].lane[lane] = surface.binding[v].node_weight[i];
  set_lane(block.rest_in_lattice, lane, surface.rest_in_lattice[v]);
}

void set_lane(const MuscleSurface& surface, std::uint32_t v, std::size_t lane, BoneBlock& block) {
  const VertexBinding& b = surface.binding[v];
  set_lane(block.rest, lane, surface.mesh.position[v]);
  block.origin.lane[lane] = b.origin;
  block.insertion.lane[lane] = b.insertion;
  block.lattice.lane[lane] = b.lattice;
}

/// Fills the blocks and returns the place of each vertex.
std::vector<std::uint16_t> fill_blocks(const MuscleSurface& surface, PackedSurface& packed) {
  std::vector<std::uint16_t> place(surface.mesh.position.size());
  std::size_t blocks = 0;
  for (const auto& [key, vertices] : grouped(surface)) {
    const auto& [kind, node] = key;
    for (std::size_t first = 0; first < vertices.size(); first += block_vertices, ++blocks) {
      const bool in_lattice = kind == Follows::lattice || kind == Follows::both;
      LatticeBlock lattice;
      BoneBlock bone;
      HeldBlock held;
      for (std::size_t lane = 0; lane < block_vertices; ++lane) {
        const std::uint32_t v = vertices[std::min(first + lane, vertices.size() - 1)];
        if (in_lattice) set_lane(surface, v, lane, lattice);
        if (kind != Follows::lattice) set_lane(surface, v, lane, bone);
        held.origin.lane[lane] = surface.binding[v].origin_held;
        held.insertion.lane[lane] = surface.binding[v].insertion_held;
        if (first + lane < vertices.size()) place[v] = static_cast<std::uint16_t>(blocks * block_vertices + lane);
      }
      if (in_lattice) packed.lattice.push_back(lattice), packed.node.push_back(node);
      if (kind != Follows::lattice) packed.bone.push_back(bone);
      if (kind == Follows::held || kind == Follows::fixed) packed.held.push_back(held);
      if (kind == Follows::fixed) ++packed.fixed_blocks;
      if (kind == Follows::lattice) ++packed.lattice_only_blocks;
    }
  }
  return place;
}

Result<void> check(const MuscleSurface& surface, std::uint32_t nodes) {
  const std::size_t vertices = surface.mesh.position.size();
  if (surface.binding.size() != vertices)
    return fail(fmt::format("{} of {} vertices are bound; bind the surface first", surface.binding.size(), vertices));
  for (std::size_t v = 0; v < vertices; ++v) {
    const VertexBinding& b = surface.binding[v];
    if (b.lattice == 0) continue;
    if (v >= surface.rest_in_lattice.size()) return fail(fmt::format("vertex {} has no place in the mesh", v));
    for (const std::uint16_t node : b.node) {
      if (node >= nodes) return fail(fmt::format("vertex {} is bound to node {} of a mesh of {}", v, node, nodes));
    }
  }
  return {};
}

template <class T>
Result<T> named(const SurfaceMesh& mesh, Result<T> result) {
  if (!result) return fail(fmt::format("surface '{}': {}", mesh.name, result.error().message), result.error().status);
  return result;
}

}  // namespace

Result<PackedSurface> pack_surface(const MuscleSurface& surface, const Body& body, std::uint32_t nodes,
                                   std::span<const AlongStencil> along) {
  if (auto done = named(surface.mesh, check(surface, nodes)); !done) return tl::unexpected(done.error());
  PackedSurface packed;
  packed.rest = surface_rest(surface, body);
  packed.nodes = nodes;
  const auto place = fill_blocks(surface, packed);
  if (packed.places() > max_places) {
    return fail(fmt::format("surface '{}': {} vertices take {} places of {}; simplify it", surface.mesh.name,
                            place.size(), packed.places(), max_places));
  }
  auto rings = named(surface.mesh, vertex_rings(surface.mesh.triangle, place));
  if (!rings) return tl::unexpected(rings.error());
  packed.rings = std::move(*rings);
  for (const AlongStencil& of : along) {
    PlacedAlong& own = packed.along.emplace_back(PlacedAlong{{}, of.weight, of.handed});
    for (std::size_t k = 0; k < 4; ++k) own.twice_place[k] = static_cast<std::uint16_t>(2 * place[of.neighbour[k]]);
  }
  return packed;
}

Result<RigidSurface> pack_rigid(const SurfaceMesh& mesh, std::span<const AlongStencil> along) {
  RigidSurface rigid;
  rigid.vertices = mesh.position.size();
  if (rigid.vertices > max_places)
    return fail(fmt::format("surface '{}': more than {} vertices; simplify it", mesh.name, max_places));
  std::vector<std::uint16_t> place(rigid.vertices);
  std::vector<float> position(4 * rigid.vertices), normal(3 * rigid.vertices);
  for (std::size_t v = 0; v < rigid.vertices; ++v) {
    place[v] = static_cast<std::uint16_t>(v);
    const Vec3<float>& p = mesh.position[v];
    std::copy_n(std::array{p.x, p.y, p.z, p.x}.begin(), 4, &position[4 * v]);
  }
  const auto rings = named(mesh, vertex_rings(mesh.triangle, place));
  if (!rings) return tl::unexpected(rings.error());
  std::vector<float> unused(3 * rigid.vertices);
  write_vertices(*rings, {}, position.data(), 1,
                 {reinterpret_cast<std::byte*>(unused.data()), reinterpret_cast<std::byte*>(normal.data()),
                  3 * sizeof(float), 3 * sizeof(float)});
  rigid.block.resize((rigid.vertices + block_vertices - 1) / block_vertices);
  for (std::size_t i = 0; i < block_vertices * rigid.block.size(); ++i) {
    const std::size_t v = std::min(i, rigid.vertices - 1);
    RigidBlock& block = rigid.block[i / block_vertices];
    set_lane(block.rest, i % block_vertices, mesh.position[v]);
    set_lane(block.normal, i % block_vertices, {normal[3 * v], normal[3 * v + 1], normal[3 * v + 2]});
  }
  for (std::size_t v = 0; v < along.size(); ++v) {
    const AlongStencil& of = along[v];
    Vec3<float> direction{0, 0, 0};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3<float> apart = mesh.position[of.neighbour[k]] - mesh.position[v];
      direction = direction + of.weight[k] * apart;
    }
    rigid.along.push_back({direction, of.handed});
  }
  return rigid;
}

}  // namespace mobil::inline v0_3
