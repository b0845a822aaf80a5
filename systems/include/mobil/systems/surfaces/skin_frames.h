#pragma once
// The frames that a skin's vertices follow, interpolated between segments.

#include <span>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Affine map of a skin frame from the anatomical position, m: three columns and the translation. The fourth number of
/// each column repeats the third.
struct FrameMap {
  alignas(16) float column[4][4];
};

/// Rotation of a segment's skin, and its centre now and at rest, m.
struct SkinBone {
  Quat<float> rotation;
  Vec3<float> now, rest;
};

/// Computes the frames of a mesh for a pose, scaled by `lengths` from the skin at rest and relative to `origin_m`.
/// maps.size() must be mesh.frame.size(). The bits are the same on every instruction set with fused multiply-add.
void frame_maps(const SkinMesh& mesh, const BodySkin& skin, const Pose<float>& pose, float lengths,
                const Vec3<float>& origin_m, std::span<FrameMap> maps);

}  // namespace mobil::inline v0_3
