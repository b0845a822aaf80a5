#pragma once
// Generalised coordinates of a walk, as MuJoCo's model has them.

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/components/body.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

enum class MujocoJoint : std::uint8_t { free, ball, hinge };

/// Returns a segment's joint. Hinges are those of knees, kneecaps and toes.
MujocoJoint mujoco_joint(Segment segment);
/// Returns the axis of a hinge, about which its angle is positive: knees and kneecaps bend, toes extend.
Eigen::Vector3d hinge_axis(Segment segment);
/// Returns the segments in the order of the model, depth first, in which MuJoCo numbers bodies and joints.
std::array<Segment, segment_count> mujoco_order();
/// Returns the child segments of a segment, in the order of Segment.
std::vector<Segment> child_segments(Segment parent);

/// A frame in generalised coordinates. Quaternions are w x y z. Angular velocities and accelerations of balls and of
/// the pelvis are in the segment's own axes, rad/s and rad/s².
struct MujocoState {
  std::vector<double> qpos, qvel, qacc;
};

/// Returns a frame's coordinates. Requires `around` of that frame.
MujocoState mujoco_state(const WalkRecording& recording, std::size_t frame);

/// Checks that a recording can be written: check_recording, `around` of each frame, joints in their places in `body`
/// and hinges that turn about their axis.
Result<void> check_mujoco(const std::filesystem::path& path, const Body& body, const WalkRecording& recording);

}  // namespace mobil::inline v0_3
