#pragma once
// A surface that deforms over time, as a mean shape and a few shapes added to it with weights that change.

#include <cstdint>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct MorphTarget {
  Eigen::Matrix3Xf position;  // displacement at weight 1, a column per vertex, m
  Eigen::Matrix3Xf normal;    // change of the normal at weight 1; the sum is to be normalised
};

struct MorphedSurface {
  Eigen::Matrix3Xf position;                // mean over the frames, m
  Eigen::Matrix3Xf normal;                  // unit length
  std::vector<MorphTarget> target;          // of falling importance
  std::vector<std::vector<float>> weight;   // [frame][target], largest magnitude of each target 1 and positive there
  double max_error_m = 0, rms_error_m = 0;  // of the rounded numbers above against the frames
};

/// Principal components of the displacement from the mean. `frames` holds a column per frame, x y z of each vertex
/// below one another (m); at most `max_targets`, fewer where every vertex of every frame is closer than `tolerance_m`.
/// Normals are the least-squares fit of the true ones with the same weights. The components are found from at most 256
/// frames spread evenly over the recording, the weights fitted to all.
MorphedSurface morph_targets(const Eigen::MatrixXd& frames, const std::vector<std::uint32_t>& triangle, int max_targets,
                             double tolerance_m);

}  // namespace mobil::inline v0_3
