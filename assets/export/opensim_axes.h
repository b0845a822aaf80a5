#pragma once
// OpenSim's axes: x ahead, y up, z to the right.

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Distance of the hips in gait2392, and offset of the pelvis' origin above and ahead of their middle, m.
inline constexpr double model_hips_m = 2 * 0.0835, model_above_m = 0.0661, model_ahead_m = 0.0707;

/// Returns a vector of mobil's axes in OpenSim's.
inline Eigen::Vector3d opensim_axes(const Eigen::Vector3d& v) {
  return {v.z(), v.y(), -v.x()};
}

}  // namespace mobil::inline v0_3
