#include <mobil/systems/surfaces/write_vertices.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#include "engine/fused-inl.h"
#include "systems/surfaces/vertex_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

/// Returns row i of the vertices at `twice_place(vertex)`: x y z x of each.
template <class Place>
HWY_INLINE EightVector looked_up(const float* places, std::size_t i, const Place& twice_place) {
  return load_vertices(eight, places + 2 * std::size_t{twice_place(i)},
                       places + 2 * std::size_t{twice_place(group_vertices == 8 ? i + 4 : i)});
}

/// Returns twice the areas that rings bound, in the order z x y: a×b of a = (x y z x) is a·b.yzx − a.yzx·b.
template <class Ring>
HWY_INLINE EightVector ring_area(const float* places, std::size_t i, const Ring& ring) {
  const auto corner = [&](std::size_t k)
                          HWY_ATTR { return looked_up(places, i, [&](std::size_t v) { return ring(v)[k]; }); };
  const EightVector p0 = corner(0), p3 = corner(3);
  const EightVector a = hn::Sub(corner(2), p0), b = hn::Sub(p3, corner(1));
  const EightVector c = hn::Sub(corner(4), p0), d = hn::Sub(corner(5), p3);
  EightVector r = hn::Mul(a, hn::Shuffle0321(b));
  EightVector s = hn::Mul(c, hn::Shuffle0321(d));
  r = neg_mul_add(hn::Shuffle0321(a), b, r);
  s = neg_mul_add(hn::Shuffle0321(c), d, s);
  return hn::Add(r, s);
}

void write_positions(const VertexRings& rings, const float* places, const VertexTarget& out) {
  for (std::size_t v = 0; v < rings.vertex.size(); ++v)
    std::memcpy(out.position + v * out.position_stride, places + 2 * std::size_t{rings.vertex[v].twice_place}, three);
}

/// Adds the areas beyond six neighbours to those of the vertices from `first` on.
HWY_NOINLINE void add_more(const float* places, std::size_t first, std::vector<MoreRing>::const_iterator begin,
                           std::vector<MoreRing>::const_iterator end, Rows& area) {
  alignas(64) float sum[4][eight_lanes], one[eight_lanes];
  for (std::size_t i = 0; i < 4; ++i) hn::Store(area.row[i], eight, sum[i]);
  for (auto more = begin; more != end; ++more) {
    const std::size_t v = more->vertex - first;
    hn::Store(ring_area(places, 0, [&](std::size_t) -> const VertexRing& { return more->ring; }), eight, one);
    for (std::size_t k = 0; k < 3; ++k) sum[v % 4][4 * (v / 4) + k] += one[k];
  }
  for (std::size_t i = 0; i < 4; ++i) area.row[i] = hn::Load(eight, sum[i]);
}

/// Writes the first `count` vertices of a group from their rings. `more` advances to the next group.
HWY_INLINE void write_group(const PlacedRing* vertex, const VertexRings& rings, std::span<const PlacedAlong> along,
                            std::vector<MoreRing>::const_iterator& more, const float* places, float sense,
                            std::size_t first, std::size_t count, bool packed, const VertexTarget& out) {
  const auto ring = [&](std::size_t v) HWY_ATTR -> const VertexRing& { return vertex[v].ring; };
  const auto own = [&](std::size_t v) HWY_ATTR { return vertex[v].twice_place; };
  Rows normal{
      {ring_area(places, 0, ring), ring_area(places, 1, ring), ring_area(places, 2, ring), ring_area(places, 3, ring)}};
  auto end = more;
  while (end != rings.more.end() && end->vertex < first + group_vertices) ++end;
  if (HWY_UNLIKELY(end != more)) add_more(places, first, more, end, normal);
  more = end;
  normalise(sense, normal);
  put({{looked_up(places, 0, own), looked_up(places, 1, own), looked_up(places, 2, own), looked_up(places, 3, own)}},
      normal, first, count, packed, out, [&](std::size_t v) {
        const PlacedAlong& of = along[v];
        const float* at = places + 2 * std::size_t{rings.vertex[v].twice_place};
        RigidAlong sum{{0, 0, 0}, sense * of.handed};
        for (std::size_t k = 0; k < 4; ++k) {
          const float* to = places + 2 * std::size_t{of.twice_place[k]};
          sum.direction.x += of.weight[k] * (to[0] - at[0]);
          sum.direction.y += of.weight[k] * (to[1] - at[1]);
          sum.direction.z += of.weight[k] * (to[2] - at[2]);
        }
        return sum;
      });
}

void write_rings(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
                 const VertexTarget& out) {
  if (out.normal == nullptr) return write_positions(rings, places, out);
  const bool packed = is_packed(out);
  const std::size_t vertices = rings.vertex.size();
  auto more = rings.more.begin();
  std::size_t first = 0;
  for (; first + group_vertices <= vertices; first += group_vertices)
    write_group(rings.vertex.data() + first, rings, along, more, places, sense, first, group_vertices, packed, out);
  if (first == vertices) return;
  PlacedRing last[group_vertices];
  for (std::size_t i = 0; i < group_vertices; ++i) last[i] = rings.vertex[std::min(first + i, vertices - 1)];
  write_group(last, rings, along, more, places, sense, first, vertices - first, packed, out);
}

void rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, const Vec3<float>& scale) {
  const bool packed = is_packed(out);
  AffineMap scaled = map, turned = map;
  const float along[3] = {scale.x, scale.y, scale.z};
  for (int c = 0; c < 3; ++c) {
    for (float& word : scaled.column[c]) word *= along[c];
    for (float& word : turned.column[c]) word *= scale.x / along[c];  // normals, which are normalised afterwards
  }
  for (std::size_t b = 0; b < surface.block.size(); ++b) {
    const EightVec p = apply<true>(scaled, load(surface.block[b].rest)),
                   n = apply<false>(turned, load(surface.block[b].normal));
    for (std::size_t i = 0; i < eight_parts; ++i) {
      const std::size_t first = block_vertices * b + group_vertices * i;
      if (first >= surface.vertices) return;
      const std::size_t count = surface.vertices - first;
      const Rows position = transposed({{p.x.part[i], p.y.part[i], p.z.part[i], p.x.part[i]}});
      if (out.normal != nullptr) {
        Rows normal = transposed({{n.z.part[i], n.x.part[i], n.y.part[i], n.z.part[i]}});
        if (scale.y != scale.x || scale.z != scale.x) normalise(1, normal);
        put(position, normal, first, count, packed, out, [&](std::size_t v) {
          const RigidAlong& of = surface.along[v];
          const Vec3<float>& d = of.direction;
          const auto row = [&](int r) {
            return scaled.column[0][r] * d.x + scaled.column[1][r] * d.y + scaled.column[2][r] * d.z;
          };
          return RigidAlong{{row(0), row(1), row(2)}, of.handed};
        });
        continue;
      }
      put_positions(position, first, count, out);
    }
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(write_rings);
HWY_EXPORT(rigid);
}  // namespace

void write_vertices(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
                    const VertexTarget& out) {
  HWY_DYNAMIC_DISPATCH(write_rings)(rings, along, places, sense, out);
}

void write_rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, const Vec3<float>& scale) {
  HWY_DYNAMIC_DISPATCH(rigid)(surface, map, out, scale);
}

}  // namespace mobil::inline v0_3
#endif
