#pragma once
// How a pose carries a skin: the frames that its vertices follow, between the segments that they lie on.

#include <span>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// How a frame of the skin carries a point from the anatomical position: along x, y and z, and from the origin; m. The
/// fourth number of each is its third again.
struct FrameMap {
  alignas(16) float column[4][4];
};

/// What a segment's skin turns with and about (m), and where that was at rest.
struct SkinBone {
  Quat<float> rotation;
  Vec3<float> now, rest;
};

/// The frames of a mesh as a pose has them, `lengths` times as large as the skin at rest, seen from `origin_m`.
/// maps.size() is mesh.frame.size(). The same bits on every instruction set with fused multiply-add.
void frame_maps(const SkinMesh& mesh, const BodySkin& skin, const Pose<float>& pose, float lengths,
                const Vec3<float>& origin_m, std::span<FrameMap> maps);

}  // namespace mobil::inline v0_3
