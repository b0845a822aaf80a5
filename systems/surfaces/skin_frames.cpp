#include <mobil/systems/surfaces/skin_frames.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <mobil/components/segments.h>
#include <mobil/engine/geometry.h>
#include "engine/fused-inl.h"
#include "systems/surfaces/weights8-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

using EightV = hn::Vec<EightTag>;

HWY_INLINE EightV set(float x) {
  return hn::Set(EightTag{}, x);
}

/// Writes a column (x y z z) of each of `eight_lanes` frames between two bones, 16 floats apart.
HWY_INLINE void put_column(const EightV& x, const EightV& y, const EightV& z, float* out) {
  const Rows rows = transposed({{x, y, z, z}});
  for (std::size_t v = 0; v < 4; ++v) store_vertices(EightTag{}, rows.row[v], out + v * 16, 16);
}

/// Writes the rotation for each `turn` of the way from `a` to `b` as a matrix, times `lengths`, about the place of `b`.
HWY_INLINE void put_maps(const SkinBone& a, const SkinBone& b, const EightV& turn, float lengths, FrameMap* maps) {
  const Quat<float>&p = a.rotation, &q = b.rotation;
  const float shorter = p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w < 0 ? -1.0F : 1.0F;
  const EightV of_b = hn::Mul(set(shorter), turn), of_a = hn::Sub(set(1), turn);
  const auto mixed = [&](float from, float to) HWY_ATTR { return mul_add(of_b, set(to), hn::Mul(of_a, set(from))); };
  const EightV x = mixed(p.x, q.x), y = mixed(p.y, q.y), z = mixed(p.z, q.z), w = mixed(p.w, q.w);
  const EightV square = mul_add(w, w, mul_add(z, z, mul_add(y, y, hn::Mul(x, x))));
  // Twice the lengths over the quaternion's squared length, which is below 1 for a mean of two.
  const EightV twice = hn::Div(set(2 * lengths), square), one = set(lengths);
  const EightV tx = hn::Mul(twice, x), ty = hn::Mul(twice, y), tz = hn::Mul(twice, z), tw = hn::Mul(twice, w);
  const EightV xx = neg_mul_add(tz, z, neg_mul_add(ty, y, one)), yy = neg_mul_add(tz, z, neg_mul_add(tx, x, one)),
               zz = neg_mul_add(ty, y, neg_mul_add(tx, x, one));
  const EightV xy = mul_add(tx, y, hn::Mul(tw, z)), yx = neg_mul_add(tw, z, hn::Mul(tx, y));
  const EightV xz = neg_mul_add(tw, y, hn::Mul(tx, z)), zx = mul_add(tx, z, hn::Mul(tw, y));
  const EightV yz = mul_add(ty, z, hn::Mul(tw, x)), zy = neg_mul_add(tw, x, hn::Mul(ty, z));
  float* const out = maps->column[0];
  put_column(xx, xy, xz, out);
  put_column(yx, yy, yz, out + 4);
  put_column(zx, zy, zz, out + 8);
  const Vec3<float>&now = b.now, &rest = b.rest;
  const auto from = [&](float at, const EightV& cx, const EightV& cy, const EightV& cz) HWY_ATTR {
    return neg_mul_add(set(rest.z), cz, neg_mul_add(set(rest.y), cy, neg_mul_add(set(rest.x), cx, set(at))));
  };
  put_column(from(now.x, xx, yx, zx), from(now.y, xy, yy, zy), from(now.z, xz, yz, zz), out + 12);
}

void put_frames(std::span<const SkinFrame> frame, const SkinBone* bone, float lengths, FrameMap* maps) {
  const std::size_t count = frame.size();
  for (std::size_t first = 0; first < count;) {
    const SkinFrame& pair = frame[first];
    std::size_t end = first + 1;
    while (end < count && frame[end].from == pair.from && frame[end].to == pair.to) ++end;
    for (std::size_t at = first; at < end; at += eight_lanes) {
      alignas(64) float turn[eight_lanes];
      for (std::size_t i = 0; i < eight_lanes; ++i) turn[i] = frame[std::min(at + i, end - 1)].turn;
      const EightV turns = hn::Load(EightTag{}, turn);
      // Lanes beyond the last frame of a pair are overwritten by the next pair.
      if (at + eight_lanes <= count) {
        put_maps(bone[pair.from], bone[pair.to], turns, lengths, maps + at);
      } else {
        FrameMap last[eight_lanes];
        put_maps(bone[pair.from], bone[pair.to], turns, lengths, last);
        std::copy(last, last + (count - at), maps + at);
      }
    }
    first = end;
  }
}

}  // namespace
}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(put_frames);

using namespace geometry;

Quat<float> of_length_1(const Quat<float>& q) {
  const float scale = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {scale * q.x, scale * q.y, scale * q.z, scale * q.w};
}

/// Returns the rotation of the forearm without its turn about its own length (y).
Quat<float> untwisted(const Quat<float>& upper_arm, const Quat<float>& forearm) {
  const Quat<float> elbow = product(conjugate(upper_arm), forearm);
  if (elbow.y * elbow.y + elbow.w * elbow.w < 1e-8F) return forearm;  // folded back on itself
  return product(forearm, conjugate(of_length_1({0, elbow.y, 0, elbow.w})));
}

}  // namespace

void frame_maps(const SkinMesh& mesh, const BodySkin& skin, const Pose<float>& pose, float lengths,
                const Vec3<float>& origin_m, std::span<FrameMap> maps) {
  std::array<SkinBone, skin_segments> bone;
  for (std::size_t s = 0; s < segment_count; ++s)
    bone[s] = {pose.rotation[s], pose.position_m[s] - origin_m, skin.standing.position_m[s]};
  for (std::size_t side = 0; side < 2; ++side) {
    const SkinBone& forearm = bone[index(on_side(Segment::forearm_right, side))];
    const SkinBone& arm = bone[index(on_side(Segment::upper_arm_right, side))];
    bone[untwisted_forearm(side)] = {untwisted(arm.rotation, forearm.rotation), forearm.now, forearm.rest};
  }
  HWY_DYNAMIC_DISPATCH(put_frames)(mesh.frame, bone.data(), lengths, maps.data());
}

}  // namespace mobil::inline v0_3
#endif
