#pragma once
// Converts world poses to a nested node hierarchy: each segment's offset and rotation from its parent.

#include <array>
#include <span>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/components/surface.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

inline Eigen::Vector3d widened(const Vec3<float>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Origins of the segments in the rest pose, m.
using StandingPlaces = std::array<Eigen::Vector3d, segment_count>;

/// One segment's transform from its parent (the pelvis's from the world): one entry if it never changes, else one per
/// frame. Rotations have unit length and consistent signs from key to key.
struct SegmentKeys {
  std::vector<Vec3<float>> translation_m;
  std::vector<Quat<float>> rotation;
};

struct RigidTransform {
  Eigen::Vector3d position_m;
  Eigen::Quaterniond rotation;
};

struct SkeletonKeys {
  std::vector<SegmentKeys> segment;                // [segment]
  SegmentKeys root;                                // of the root in the world; one entry each without roots
  std::vector<std::vector<RigidTransform>> world;  // [frame][segment], recomposed from the rounded keys
};

/// Measures each segment from its parent as recomposed from the keys, so that rounding does not add up along the chain.
/// An offset that stays at that of `rest` is exactly that one. Every recomposed position is within about 5 µm + four
/// roundings of its world position. Requires at least one frame, finite numbers and rotations of non-zero length.
/// With roots, of each frame, the pelvis is relative to them.
SkeletonKeys skeleton_keys(const std::vector<Pose<float>>& frames, const StandingPlaces& rest,
                           std::span<const RecordedRoot> root = {});

/// Returns a root's place in the world.
RigidTransform root_transform(const RecordedRoot& root);

/// Returns each segment's offset from its parent at rest, rounded; the pelvis' from the world.
Vec3<float> rest_offset(const StandingPlaces& rest, std::size_t segment);

/// Return true if a segment moves from its place at rest, or turns, in any frame.
bool leaves_rest(const SegmentKeys& keys, const Vec3<float>& rest_offset_m);
bool turns(const SegmentKeys& keys);

/// Returns a rest pose for recordings without one: no segment is turned, and each has its mean offset from its parent
/// over the recording. The pelvis is at x = z = 0, so high that the lowest vertex of the surfaces (the lowest joint,
/// without any) is at y = 0.
StandingPlaces standing_places(const std::vector<Pose<float>>& frames, std::span<const BoneSurface> surfaces);

}  // namespace mobil::inline v0_3
