#pragma once
// Muscles of MuJoCo's model: sites and wrapping edges on bodies, tendons over them, actuators.

#include <array>
#include <string>

#include <mobil/components/body.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Parts of MJCF. `on_segment` has elements of each segment's body, one a line, without indentation.
struct MujocoMuscles {
  std::array<std::string, segment_count> on_segment;
  std::string tendons, actuators;
};

/// Returns the lines of all muscles of both legs. A point of a path is a site. An edge is a cylinder of 0.1 mm along x
/// with a site on the side where the path must be; of two edges in a row it is the first. A path that ends on the
/// kneecap ends there at its anatomical place, on the body of the kneecap.
MujocoMuscles mujoco_muscles(const Body& body);

}  // namespace mobil::inline v0_3
