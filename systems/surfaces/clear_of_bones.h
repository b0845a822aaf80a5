#pragma once
// Muscle vertices moved out of the bones of the pose.

#include <array>
#include <cstddef>

#include <mobil/systems/surfaces/skin_pose.h>
#include "assets/surfaces/leg_bones.h"

namespace mobil::inline v0_3 {

/// Pose of a bone in the present world, and its scale relative to the bones that surfaces were bound to: of all
/// lengths, and along the bone relative to that.
struct PosedBone {
  RigidPose pose;
  Vec3<float> scale{1, 1, 1};
};

/// Moves places that are within the bones of one side to their surface: x y z x of one place after the other, m, as
/// place_vertices writes them. `posed` is in the order of LegBones::hard. Other places keep their bits.
void keep_clear(const LegBones& bones, const std::array<PosedBone, LegBones::hard.size()>& posed, Side side,
                float* places, std::size_t count);

}  // namespace mobil::inline v0_3
