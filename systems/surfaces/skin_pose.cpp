#include <mobil/systems/surfaces/skin_pose.h>

#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>

namespace mobil::inline v0_3 {
namespace {

using namespace geometry;

RigidPose mirror_image(const RigidPose& p) {
  return {mirrored(p.position_m), mirrored(p.rotation)};
}

/// Returns the rotation at a part of the shorter way from `a` (0) to `b` (1).
Quat<float> between(const Quat<float>& a, const Quat<float>& b, float part) {
  const float same = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  const float wa = 1 - part, wb = same < 0 ? -part : part;
  const Quat<float> q{wa * a.x + wb * b.x, wa * a.y + wb * b.y, wa * a.z + wb * b.z, wa * a.w + wb * b.w};
  const float n = 1 / std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {n * q.x, n * q.y, n * q.z, n * q.w};
}

/// Returns now ∘ stretched along y ∘ rest⁻¹.
AffineMap motion(const RigidPose& now, const RigidPose& rest, float stretch) {
  const AffineMap a = affine_map(now), b = affine_map(rest);
  AffineMap m{};
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) m.column[c][r] += a.column[k][r] * (k == 1 ? stretch : 1.0F) * b.column[k][c];
    }
  }
  for (int r = 0; r < 3; ++r) {
    m.column[3][r] = a.column[3][r];
    for (int k = 0; k < 3; ++k) m.column[3][r] -= m.column[k][r] * b.column[3][k];
  }
  return m;
}

SurfaceEnd surface_end(const Body& body, Segment right_bone, const Vec3<float>& attachment_m, float turn) {
  SurfaceEnd end{{}, {}, attachment_m, turn};
  const Pose<float> standing = standing_pose(body);
  for (const Side side : {Side::right, Side::left}) {
    end.bone[side] = right_bone < Segment::thigh_right ? right_bone : on_side(right_bone, side);
    end.bone_m[side] = standing.position_m[index(end.bone[side])];
  }
  return end;
}

/// Returns the motion of points of the body to which the surface was bound. `lengths` is relative to that body,
/// `stretch` is relative to `lengths`, along the bone's own axis. Points that turn with the muscle move with its place
/// on the bone and are not stretched themselves.
AffineMap end_map(const SurfaceEnd& end, Side side, RigidPose now, const Quat<float>& muscle_turn, float turn,
                  float lengths, float stretch) {
  RigidPose rest{lengths * end.bone_m[side], {0, 0, 0, 1}};
  if (turn != 0) {
    const Vec3<float> at = lengths * (side == Side::left ? mirrored(end.attachment_m) : end.attachment_m);
    Vec3<float> arm = at - rest.position_m;
    arm.y *= stretch;
    now = {now.position_m + rotated(now.rotation, arm), between(now.rotation, muscle_turn, turn)};
    rest.position_m = at;
    stretch = 1;
  }
  AffineMap map =
      side == Side::left ? motion(mirror_image(now), mirror_image(rest), stretch) : motion(now, rest, stretch);
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
  const Quat<float> muscle_turn = side == Side::left ? mirrored(in_image) : in_image;
  origin.position_m = origin.position_m - from_m;
  insertion.position_m = insertion.position_m - from_m;
  const RigidPose frame{line.start_m - (side == Side::left ? mirrored(from_m) : from_m), line.rotation};
  const auto of_origin = [&](float turn) {
    return end_map(rest.origin, side, origin, muscle_turn, turn, scale.lengths, scale.origin);
  };
  const auto of_insertion = [&](float turn) {
    return end_map(rest.insertion, side, insertion, muscle_turn, turn, scale.lengths, scale.insertion);
  };
  return {
      affine_map(frame), of_origin(rest.origin.turn), of_insertion(rest.insertion.turn), of_origin(0), of_insertion(0),
      scale.belly};
}

}  // namespace mobil::inline v0_3
