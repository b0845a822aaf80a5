#pragma once
// People put on a stage, and pictures taken of it.

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/systems/capture/camera.h>
#include <mobil/systems/capture/image.h>
#include "demo/lab/paper/paper_cycle.h"

namespace mobil {

/// One moment of a walk. The point of the ground below the pelvis is put at `at`.
struct Actor {
  const ShownWalk* walk = nullptr;
  std::size_t frame = 0;
  Vec3<float> at{0, 0, 0};
  enum class Bones : std::uint8_t { all, right_leg, none } bones = Bones::all;
  enum class Muscles : std::uint8_t { both, right, none } muscles = Muscles::both;
  bool mesh = false;  // the right leg's finite-element meshes, as lines
};

struct Stage {
  Camera camera;
  int width = 640, height = 480;
  bool ground = true;
};

/// From the right of people who walk toward +z (which is to the right in the picture) and somewhat in front of them:
/// `turn_deg` from the side, `rise_deg` above. Holds about `tall_m` of height at the target, hardly any perspective.
Camera camera_at(const Vec3<float>& target, float tall_m, float turn_deg, float rise_deg);

/// The direction to the right in pictures of that camera, of unit length.
Vec3<float> across(const Camera& camera);

/// People `apart_m` from one another, each in their own first frame, from left to right before the camera.
std::vector<Actor> side_by_side(std::span<const PaperCycle> walks, const Camera& camera, float apart_m);

/// Errors: no graphics device or driver.
Result<Image> take_picture(const Stage& stage, std::span<const Actor> actors);

}  // namespace mobil
