// A few vertices as rows of registers, and output to a caller's buffer. For inclusion inside Highway's targets only.

#if defined(MOBIL_SYSTEMS_SKINNING_VERTEX_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_SKINNING_VERTEX_ROWS_INL_H_
#undef MOBIL_SYSTEMS_SKINNING_VERTEX_ROWS_INL_H_
#else
#define MOBIL_SYSTEMS_SKINNING_VERTEX_ROWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include <mobil/systems/surfaces/write_vertices.h>
#include "engine/fused-inl.h"
#include "systems/surfaces/weights8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

inline constexpr EightTag eight;
using EightVector = hn::Vec<EightTag>;

inline constexpr std::size_t group_vertices = 4 * (eight_lanes / 4);  // of one Rows
inline constexpr std::size_t six = 6 * sizeof(float), three = 3 * sizeof(float);

/// Scales rows z x y to length |`sense`|, with its sign. Rows without a length point up.
HWY_INLINE void normalise(float sense, Rows& normal) {
  const Rows v = transposed(normal);
  const auto square = mul_add(v.row[2], v.row[2], mul_add(v.row[1], v.row[1], hn::Mul(v.row[0], v.row[0])));
  const auto has_length = hn::Gt(square, hn::Set(eight, 1e-36F));  // a triangle of a square micrometre: 1e-24
  const EightVector factor = hn::Div(hn::Set(eight, sense), hn::Sqrt(square));
  if (HWY_LIKELY(hn::AllTrue(eight, has_length))) {
    normal.row[0] = hn::Mul(normal.row[0], hn::Broadcast<0>(factor));
    normal.row[1] = hn::Mul(normal.row[1], hn::Broadcast<1>(factor));
    normal.row[2] = hn::Mul(normal.row[2], hn::Broadcast<2>(factor));
    normal.row[3] = hn::Mul(normal.row[3], hn::Broadcast<3>(factor));
    return;
  }
  const EightVector up = hn::IfThenElse(has_length, hn::Mul(v.row[2], factor), hn::Set(eight, 1.0F));
  normal = transposed({{hn::IfThenElseZero(has_length, hn::Mul(v.row[0], factor)),
                        hn::IfThenElseZero(has_length, hn::Mul(v.row[1], factor)), up, up}});
}

/// Return `a` with lane 3 (lane 0) of `b`.
HWY_INLINE EightVector with_last(const EightVector& a, const EightVector& b) {
  alignas(32) static constexpr std::uint32_t last[8] = {0, 0, 0, ~0U, 0, 0, 0, ~0U};
  return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(eight, hn::Load(hn::RebindToUnsigned<EightTag>{}, last))), b, a);
}
HWY_INLINE EightVector with_first(const EightVector& a, const EightVector& b) {
  alignas(32) static constexpr std::uint32_t first[8] = {~0U, 0, 0, 0, ~0U, 0, 0, 0};
  return hn::IfThenElse(hn::MaskFromVec(hn::BitCast(eight, hn::Load(hn::RebindToUnsigned<EightTag>{}, first))), b, a);
}

/// Interleaves a group's positions (x y z) and normals (z x y), six floats a vertex.
HWY_INLINE void interleave(const Rows& position, const Rows& normal, float* out) {
  const hn::RepartitionToWide<EightTag> two;
  for (std::size_t i = 0; i < 4; i += 2) {
    const EightVector &p = position.row[i], &q = position.row[i + 1], &n = normal.row[i], &m = normal.row[i + 1];
    const EightVector swapped = hn::Shuffle1032(n);  // y ? z x
    const EightVector yz = hn::InterleaveLower(eight, swapped, n);
    const EightVector middle = hn::BitCast(eight, hn::InterleaveLower(two, hn::BitCast(two, yz), hn::BitCast(two, q)));
    store_vertices(eight, with_last(p, swapped), out + 6 * i, 6);
    store_vertices(eight, middle, out + 6 * i + 4, 6);
    store_vertices(eight, with_first(with_last(m, hn::Shuffle0321(m)), hn::Shuffle1032(q)), out + 6 * i + 8, 6);
  }
}

/// Copies finished vertices, six floats each, to a buffer with another layout. Each piece is within one register stored
/// before.
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

/// Returns true if vertices are position and normal and nothing else.
inline bool is_packed(const VertexTarget& out) {
  return out.normal == out.position + three && out.position_stride == six && out.normal_stride == six &&
         out.tangent == nullptr;
}

/// Writes the normalised part of a direction at right angles to a unit normal, or some such vector if it is 0.
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

/// Writes the positions of the first `count` vertices of a group.
HWY_INLINE void put_positions(const Rows& position, std::size_t first, std::size_t count, const VertexTarget& out) {
  alignas(64) float place[4 * group_vertices];
  for (std::size_t k = 0; k < 4; ++k) store_vertices(eight, position.row[k], place + 4 * k, 4);
  for (std::size_t v = 0; v < std::min(count, group_vertices); ++v)
    std::memcpy(out.position + (first + v) * out.position_stride, place + 4 * v, three);
}

/// Writes the first `count` vertices of a group. `along(v)` returns the direction along the surface and its sense, for
/// requests with tangents.
template <class Along>
HWY_INLINE void put(const Rows& position, const Rows& normal, std::size_t first, std::size_t count, bool packed,
                    const VertexTarget& out, const Along& along) {
  if (packed && count >= group_vertices) {
    interleave(position, normal, reinterpret_cast<float*>(out.position + first * six));
    return;
  }
  alignas(64) float vertex[6 * group_vertices];
  interleave(position, normal, vertex);
  hand_over(vertex, first, std::min(count, group_vertices), out);
  if (out.tangent == nullptr) return;
  for (std::size_t v = 0; v < std::min(count, group_vertices); ++v) {
    const RigidAlong own = along(first + v);
    put_tangent(own.direction, own.handed, vertex + 6 * v + 3, out.tangent + (first + v) * out.tangent_stride);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
