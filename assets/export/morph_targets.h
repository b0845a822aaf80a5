#pragma once
// A surface that deforms over time, as a shape and a few shapes added to it with varying weights.

#include <cstdint>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

struct MorphTarget {
  Eigen::Matrix3Xf position;  // displacement at weight 1, a column per vertex, m
  Eigen::Matrix3Xf normal;    // change of the normal at weight 1; normalise the sum
};

struct MorphedSurface {
  Eigen::Matrix3Xf position;                // without targets, m
  Eigen::Matrix3Xf normal;                  // unit length
  std::vector<MorphTarget> target;          // of falling importance
  std::vector<std::vector<float>> weight;   // [frame][target], 0 to 1, both of which each target reaches
  double max_error_m = 0, rms_error_m = 0;  // of the rounded numbers above against the frames
};

/// Finds the principal components of the displacement from the mean. `frames` has a column per frame, x y z of each
/// vertex below one another (m). Returns `max_targets` or fewer, if every vertex of every frame is then closer than
/// `tolerance_m`. Normals are a least-squares fit of the true ones with the same weights. The components come from up
/// to 256 frames spread evenly over the recording; weights are fitted to all.
MorphedSurface morph_targets(const Eigen::MatrixXd& frames, const std::vector<std::uint32_t>& triangle, int max_targets,
                             double tolerance_m);

}  // namespace mobil::inline v0_3
