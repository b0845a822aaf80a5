#include "systems/skinning/write_vertices.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "systems/skinning/write_vertices.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/fused-inl.h"
#include "systems/skinning/eight-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace {

constexpr EightTag tag;
using Vector = hn::Vec<EightTag>;

constexpr std::size_t group = 4 * (eight_lanes / 4);  // vertices of one Rows
constexpr std::size_t six = 6 * sizeof(float), three = 3 * sizeof(float);

/// Row i of what `twice_place(vertex)` says: x y z x of a vertex.
template <class Place>
HWY_INLINE Vector looked_up(const float* places, std::size_t i, const Place& twice_place) {
  return load_vertices(tag, places + 2 * std::size_t{twice_place(i)},
                       places + 2 * std::size_t{twice_place(group == 8 ? i + 4 : i)});
}

/// Twice the areas that rings bound, their components in the order z x y: a×b of a = (x y z x) is a·b.yzx − a.yzx·b.
template <class Ring>
HWY_INLINE Vector ring_area(const float* places, std::size_t i, const Ring& ring) {
  const auto corner = [&](std::size_t k)
                          HWY_ATTR { return looked_up(places, i, [&](std::size_t v) { return ring(v)[k]; }); };
  const Vector p0 = corner(0), p3 = corner(3);
  const Vector a = hn::Sub(corner(2), p0), b = hn::Sub(p3, corner(1));
  const Vector c = hn::Sub(corner(4), p0), d = hn::Sub(corner(5), p3);
  Vector r = hn::Mul(a, hn::Shuffle0321(b));
  Vector s = hn::Mul(c, hn::Shuffle0321(d));
  r = neg_mul_add(hn::Shuffle0321(a), b, r);
  s = neg_mul_add(hn::Shuffle0321(c), d, s);
  return hn::Add(r, s);
}

/// Makes rows z x y as long as `sense` says; those without a length point up.
HWY_INLINE void normalise(float sense, Rows& normal) {
  const Rows v = transposed(normal);
  const auto square = mul_add(v.row[2], v.row[2], mul_add(v.row[1], v.row[1], hn::Mul(v.row[0], v.row[0])));
  const auto has_length = hn::Gt(square, hn::Set(tag, 1e-36F));  // a triangle of a square micrometre: 1e-24
  const Vector factor = hn::Div(hn::Set(tag, sense), hn::Sqrt(square));
  if (HWY_LIKELY(hn::AllTrue(tag, has_length))) {
    normal.row[0] = hn::Mul(normal.row[0], hn::Broadcast<0>(factor));
    normal.row[1] = hn::Mul(normal.row[1], hn::Broadcast<1>(factor));
    normal.row[2] = hn::Mul(normal.row[2], hn::Broadcast<2>(factor));
    normal.row[3] = hn::Mul(normal.row[3], hn::Broadcast<3>(factor));
    return;
  }
  const Vector up = hn::IfThenElse(has_length, hn::Mul(v.row[2], factor), hn::Set(tag, 1.0F));
  normal = transposed({{hn::IfThenElseZero(has_length, hn::Mul(v.row[0], factor)),
                        hn::IfThenElseZero(has_length, hn::Mul(v.row[1], factor)), up, up}});
}

/// Lane 3 (lane 0) of `b`, the others of `a`.
HWY_INLINE Vector with_last(const Vector& a, const Vector& b) {
  alignas(32) static constexpr std::uint32_t last[8] = {0, 0, 0, ~0U, 0, 0, 0, ~0U};
  return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(tag, hn::Load(hn::RebindToUnsigned<EightTag>{}, last))), b, a);
}
HWY_INLINE Vector with_first(const Vector& a, const Vector& b) {
  alignas(32) static constexpr std::uint32_t first[8] = {~0U, 0, 0, 0, ~0U, 0, 0, 0};
  return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(tag, hn::Load(hn::RebindToUnsigned<EightTag>{}, first))), b, a);
}

/// Puts a group's positions (x y z) and normals (z x y) together, six floats a vertex.
HWY_INLINE void interleave(const Rows& position, const Rows& normal, float* out) {
  const hn::RepartitionToWide<EightTag> two;
  for (std::size_t i = 0; i < 4; i += 2) {
    const Vector &p = position.row[i], &q = position.row[i + 1], &n = normal.row[i], &m = normal.row[i + 1];
    const Vector swapped = hn::Shuffle1032(n);  // y ? z x
    const Vector yz = hn::InterleaveLower(tag, swapped, n);
    const Vector middle = hn::BitCast(tag, hn::InterleaveLower(two, hn::BitCast(two, yz), hn::BitCast(two, q)));
    store_vertices(tag, with_last(p, swapped), out + 6 * i, 6);
    store_vertices(tag, middle, out + 6 * i + 4, 6);
    store_vertices(tag, with_first(with_last(m, hn::Shuffle0321(m)), hn::Shuffle1032(q)), out + 6 * i + 8, 6);
  }
}

/// Hands over what lies ready, six floats a vertex, to a buffer that is laid out otherwise. Each piece lies within one
/// register stored before.
HWY_INLINE void hand_over(const float* vertex, std::size_t first, std::size_t count, const VertexTarget& out) {
  std::byte* position = out.position + first * out.position_stride;
  std::byte* normal = out.normal + first * out.normal_stride;
  const bool together = normal == position + three && out.position_stride == out.normal_stride;
  for (std::size_t i = 0; i < count; ++i, vertex += 6) {
    std::memcpy(position, vertex, 8);
    if (together) {
      std::memcpy(position + 8, vertex + 2, 8);
    } else {
      std::memcpy(position + 8, vertex + 2, 4);
      std::memcpy(normal, vertex + 3, 4);
    }
    std::memcpy(normal + 4, vertex + 4, 8);
    position += out.position_stride;
    normal += out.normal_stride;
  }
}

/// Whether vertices are position and normal and nothing else.
bool is_packed(const VertexTarget& out) {
  return out.normal == out.position + three && out.position_stride == six && out.normal_stride == six &&
         out.tangent == nullptr;
}

/// What of a direction is at right angles to a unit normal, of length 1; some such direction where nothing is left.
HWY_INLINE void put_tangent(const Vec3<float>& along, float handed, const float* normal, std::byte* out) {
  const float nx = normal[0], ny = normal[1], nz = normal[2];
  const float through = along.x * nx + along.y * ny + along.z * nz;
  float t[4] = {along.x - through * nx, along.y - through * ny, along.z - through * nz, handed};
  float square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  if (!(square > 1e-12F)) {
    const bool upright = ny * ny > 0.5F;
    t[0] = upright ? 0.0F : nz, t[1] = upright ? -nz : 0.0F, t[2] = upright ? ny : -nx;
    square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  }
  const float length = std::sqrt(square);
  for (std::size_t c = 0; c < 3; ++c) t[c] /= length;
  std::memcpy(out, t, sizeof t);
}

/// A group of vertices, of which `count` are wanted. `along(v)`: the direction along the surface and its sense, of who
/// wants tangents.
template <class Along>
HWY_INLINE void put(const Rows& position, const Rows& normal, std::size_t first, std::size_t count, bool packed,
                    const VertexTarget& out, const Along& along) {
  if (packed && count >= group) {
    interleave(position, normal, reinterpret_cast<float*>(out.position + first * six));
    return;
  }
  alignas(64) float vertex[6 * group];
  interleave(position, normal, vertex);
  hand_over(vertex, first, std::min(count, group), out);
  if (out.tangent == nullptr) return;
  for (std::size_t v = 0; v < std::min(count, group); ++v) {
    const RigidAlong own = along(first + v);
    put_tangent(own.direction, own.handed, vertex + 6 * v + 3, out.tangent + (first + v) * out.tangent_stride);
  }
}

void write_positions(const VertexRings& rings, const float* places, const VertexTarget& out) {
  for (std::size_t v = 0; v < rings.vertex.size(); ++v)
    std::memcpy(out.position + v * out.position_stride, places + 2 * std::size_t{rings.vertex[v].twice_place}, three);
}

/// Adds what six neighbours lack to the areas of the vertices `first` and on.
HWY_NOINLINE void add_more(const float* places, std::size_t first, std::vector<MoreRing>::const_iterator begin,
                           std::vector<MoreRing>::const_iterator end, Rows& area) {
  alignas(64) float sum[4][eight_lanes], one[eight_lanes];
  for (std::size_t i = 0; i < 4; ++i) hn::Store(area.row[i], tag, sum[i]);
  for (auto more = begin; more != end; ++more) {
    const std::size_t v = more->vertex - first;
    hn::Store(ring_area(places, 0, [&](std::size_t) -> const VertexRing& { return more->ring; }), tag, one);
    for (std::size_t k = 0; k < 3; ++k) sum[v % 4][4 * (v / 4) + k] += one[k];
  }
  for (std::size_t i = 0; i < 4; ++i) area.row[i] = hn::Load(tag, sum[i]);
}

/// A group of vertices from their rings, of which `count` are wanted; `more` goes on to the next group.
HWY_INLINE void write_group(const PlacedRing* vertex, const VertexRings& rings, std::span<const PlacedAlong> along,
                            std::vector<MoreRing>::const_iterator& more, const float* places, float sense,
                            std::size_t first, std::size_t count, bool packed, const VertexTarget& out) {
  const auto ring = [&](std::size_t v) HWY_ATTR -> const VertexRing& { return vertex[v].ring; };
  const auto own = [&](std::size_t v) HWY_ATTR { return vertex[v].twice_place; };
  Rows normal{
      {ring_area(places, 0, ring), ring_area(places, 1, ring), ring_area(places, 2, ring), ring_area(places, 3, ring)}};
  auto end = more;
  while (end != rings.more.end() && end->vertex < first + group) ++end;
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

void write(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
           const VertexTarget& out) {
  if (out.normal == nullptr) return write_positions(rings, places, out);
  const bool packed = is_packed(out);
  const std::size_t vertices = rings.vertex.size();
  auto more = rings.more.begin();
  std::size_t first = 0;
  for (; first + group <= vertices; first += group)
    write_group(rings.vertex.data() + first, rings, along, more, places, sense, first, group, packed, out);
  if (first == vertices) return;
  PlacedRing last[group];
  for (std::size_t i = 0; i < group; ++i) last[i] = rings.vertex[std::min(first + i, vertices - 1)];
  write_group(last, rings, along, more, places, sense, first, vertices - first, packed, out);
}

void rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, float scale, float stretch) {
  const bool packed = is_packed(out);
  AffineMap scaled = map, turned = map;
  for (int c = 0; c < 3; ++c) {
    for (float& word : scaled.column[c]) word *= c == 1 ? scale * stretch : scale;
  }
  for (float& word : turned.column[1]) word /= stretch;  // normals, whose length is made 1 again
  for (std::size_t b = 0; b < surface.block.size(); ++b) {
    const EightVec p = apply<true>(scaled, load(surface.block[b].rest)),
                   n = apply<false>(turned, load(surface.block[b].normal));
    for (std::size_t i = 0; i < eight_parts; ++i) {
      const std::size_t first = block_vertices * b + group * i;
      if (first >= surface.vertices) return;
      const std::size_t count = surface.vertices - first;
      const Rows position = transposed({{p.x.part[i], p.y.part[i], p.z.part[i], p.x.part[i]}});
      if (out.normal != nullptr) {
        Rows normal = transposed({{n.z.part[i], n.x.part[i], n.y.part[i], n.z.part[i]}});
        if (stretch != 1) normalise(1, normal);
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
      alignas(64) float place[4 * group];
      for (std::size_t k = 0; k < 4; ++k) store_vertices(tag, position.row[k], place + 4 * k, 4);
      for (std::size_t v = 0; v < std::min(count, group); ++v)
        std::memcpy(out.position + (first + v) * out.position_stride, place + 4 * v, three);
    }
  }
}

}  // namespace
}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil {
namespace {
HWY_EXPORT(write);
HWY_EXPORT(rigid);
}  // namespace

void write_vertices(const VertexRings& rings, std::span<const PlacedAlong> along, const float* places, float sense,
                    const VertexTarget& out) {
  HWY_DYNAMIC_DISPATCH(write)(rings, along, places, sense, out);
}

void write_rigid(const RigidSurface& surface, const AffineMap& map, const VertexTarget& out, float scale,
                 float stretch) {
  HWY_DYNAMIC_DISPATCH(rigid)(surface, map, out, scale, stretch);
}

}  // namespace mobil
#endif
