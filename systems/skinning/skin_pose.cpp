#include "systems/skinning/skin_pose.h"

#include <cmath>

#include "engine/geometry.h"

namespace mobil {
namespace {

using namespace geometry;

RigidPose mirror_image(const RigidPose& p) {
  return {mirrored(p.position_m), mirrored(p.rotation)};
}

/// The rotation a part of the shorter way from `a` (0) to `b` (1).
Quat<float> between(const Quat<float>& a, const Quat<float>& b, float part) {
  const float same = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const float wa = 1 - part, wb = same < 0 ? -part : part;
  const Quat<float> q{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
  const float n = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {n * q.x, n * q.y, n * q.z, n * q.w};
}

/// now ∘ rest⁻¹.
AffineMap motion(const RigidPose& now, const RigidPose& rest) {
  const AffineMap a = affine_map(now), b = affine_map(rest);
  AffineMap m{};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) m.column[c][r] += a.column[k][r] * b.column[k][c];
    }
  }
  for (int r = 0; r < 3; ++r) {
    m.column[3][r] = a.column[3][r];
    for (int k = 0; k < 3; ++k) m.column[3][r] -= m.column[k][r] * b.column[3][k];
  }
  return m;
}

Vec3<float> standing_place(const Body& body, Segment s) {
  Vec3<float> p = body.joint_offset_m[index(s)];
  while (s != segment_parent[index(s)]) {
    s = segment_parent[index(s)];
    p = p + body.joint_offset_m[index(s)];
  }
  return p;
}

SurfaceEnd surface_end(const Body& body, Segment right_bone, const Vec3<float>& attachment_m, float turn) {
  SurfaceEnd end{{}, {}, attachment_m, turn};
  for (const Side side : {right, left}) {
    end.bone[side] = right_bone < Segment::thigh_right ? right_bone : on_side(right_bone, side);
    end.bone_m[side] = standing_place(body, end.bone[side]);
  }
  return end;
}

/// Of points of the body that the surface was bound to; `lengths`: of this one's over that one's.
AffineMap end_map(const SurfaceEnd& end, Side side, RigidPose now, const Quat<float>& muscle_turn, float lengths) {
  RigidPose rest{lengths * end.bone_m[side], {0, 0, 0, 1}};
  if (end.turn != 0) {
    const Vec3<float> at = lengths * (side == left ? mirrored(end.attachment_m) : end.attachment_m);
    now = {now.position_m + rotated(now.rotation, at - rest.position_m), between(now.rotation, muscle_turn, end.turn)};
    rest.position_m = at;
  }
  AffineMap map = side == left ? motion(mirror_image(now), mirror_image(rest)) : motion(now, rest);
  for (int c = 0; c < 3; ++c) {
    for (float& word : map.column[c]) word *= lengths;
  }
  return map;
}

}  // namespace

AffineMap affine_map(const RigidPose& p) {
  const auto [x, y, z] = columns(p.rotation);
  const Vec3<float>& at = p.position_m;
  return {{{x.x, x.y, x.z, 0}, {y.x, y.y, y.z, 0}, {z.x, z.y, z.z, 0}, {at.x, at.y, at.z, 0}}};
}

SurfaceRest surface_rest(const MuscleSurface& surface, const Body& body) {
  return {surface.rest_rotation, surface_end(body, surface.origin, surface.origin_m, surface.origin_turn),
          surface_end(body, surface.insertion, surface.insertion_m, surface.insertion_turn)};
}

SkinMaps skin_maps(const SurfaceRest& rest, Side side, RigidPose origin, RigidPose insertion,
                   const LineOfAction<float>& line, const Vec3<float>& from_m, const SurfaceScale& scale) {
  const Quat<float> in_image = product(line.rotation, conjugate(rest.rotation));
  const Quat<float> muscle_turn = side == left ? mirrored(in_image) : in_image;
  origin.position_m = origin.position_m - from_m;
  insertion.position_m = insertion.position_m - from_m;
  const RigidPose frame{line.start_m - (side == left ? mirrored(from_m) : from_m), line.rotation};
  return {affine_map(frame), end_map(rest.origin, side, origin, muscle_turn, scale.lengths),
          end_map(rest.insertion, side, insertion, muscle_turn, scale.lengths), scale.belly};
}

}  // namespace mobil
