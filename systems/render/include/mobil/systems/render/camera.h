#pragma once
// A pinhole camera that looks at a point, alone or as a pair of eyes.

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// World frame: metres, +Y up; the picture is upright. The window may be shifted sideways for a pair of eyes.
struct Camera {
  Vec3<float> eye{2.2F, 1.4F, 3.2F}, target{0, 0.95F, 0};
  float vertical_fov_deg = 30;
  float window_shift = 0;  // to the right, in units of the distance to the window
};

/// Right, up and backward (from the target to the eye): the camera's axes in the world.
struct CameraAxes {
  Vec3<float> right, up, back;
};
CameraAxes camera_axes(const Camera& camera);

/// Two cameras with parallel axes whose windows coincide at the target: what is there has no disparity, what is nearer
/// stands before the screen. `separation_m`: distance between the eyes (0.064 for a person).
struct StereoPair {
  Camera left, right;
};
StereoPair stereo_pair(const Camera& camera, float separation_m);

/// Where a world point falls in a picture of that size: x and y in pixels from its upper left corner, z the distance
/// along the camera's axis in m (negative behind the camera; then x and y mean nothing).
Vec3<float> project(const Camera& camera, int width, int height, Vec3<float> point);

}  // namespace mobil::inline v0_3
