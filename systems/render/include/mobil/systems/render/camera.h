#pragma once
// A pinhole camera that looks at a point, single or as a stereo pair.

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// A camera in the world frame (m, +Y up). The picture is upright. The window can be shifted sideways for stereo.
struct Camera {
  Vec3<float> eye{2.2F, 1.4F, 3.2F}, target{0, 0.95F, 0};
  float vertical_fov_deg = 30;
  float window_shift = 0;  // to the right, in units of the distance to the window
};

/// The camera's axes in the world: right, up and backward (from the target to the eye).
struct CameraAxes {
  Vec3<float> right, up, back;
};
CameraAxes camera_axes(const Camera& camera);

/// Two cameras with parallel axes whose windows coincide at the target. Objects there have no disparity, and nearer
/// ones appear in front of the screen. `separation_m` is the distance between the eyes (0.064 for a person).
struct StereoPair {
  Camera left, right;
};
StereoPair stereo_pair(const Camera& camera, float separation_m);

/// Projects a world point into a picture of that size. x and y are in pixels from the upper left corner, and z is the
/// distance along the camera's axis, m. If z is negative (behind the camera), x and y are meaningless.
Vec3<float> project(const Camera& camera, int width, int height, Vec3<float> point);

}  // namespace mobil::inline v0_3
