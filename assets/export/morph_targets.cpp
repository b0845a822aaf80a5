#include "assets/export/morph_targets.h"

#include <algorithm>
#include <cmath>

#include "assets/export/mesh_shading.h"
#include "assets/reduction/dense.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index max_samples = 256;

/// Returns orthonormal columns that span the largest displacements, most important first (method of snapshots: the
/// eigenvectors of the small frames × frames matrix).
MatrixXd principal_shapes(const MatrixXd& displacement, Index count) {
  const Index samples = std::min(displacement.cols(), max_samples);
  MatrixXd sampled(displacement.rows(), samples);
  for (Index i = 0; i < samples; ++i) sampled.col(i) = displacement.col(i * displacement.cols() / samples);
  const SymmetricEigen eigen = symmetric_eigen(product(transposed(sampled), sampled));
  const double negligible = 1e-12 * std::max(eigen.values(samples - 1), 1e-18);
  MatrixXd shapes(displacement.rows(), std::min(count, samples));
  Index kept = 0;
  for (; kept < shapes.cols() && eigen.values(samples - 1 - kept) > negligible; ++kept) {
    shapes.col(kept) = product(sampled, VectorXd(eigen.vectors.col(samples - 1 - kept))).normalized();
  }
  shapes.conservativeResize(Eigen::NoChange, kept);
  return shapes;
}

double largest_vertex(const MatrixXd& displacement) {
  return std::sqrt(
      Eigen::Map<const Matrix3Xd>(displacement.data(), 3, displacement.size() / 3).colwise().squaredNorm().maxCoeff());
}

Matrix3Xd as_vertices(const VectorXd& stacked) {
  return Eigen::Map<const Matrix3Xd>(stacked.data(), 3, stacked.size() / 3);
}

/// Fits the mean normal and its change with each weight, scaled so that the mean has unit length. Only the direction of
/// their sum matters.
void fit_normals(const MatrixXd& frames, const std::vector<std::uint32_t>& triangle, const MatrixXd& weight,
                 MorphedSurface& surface) {
  const Index vertices = frames.rows() / 3, targets = weight.cols();
  MatrixXd design(frames.cols(), targets + 1);  // constant, then the weights
  design.col(0).setOnes();
  design.rightCols(targets) = weight;
  const MatrixXd solve = solved(product(transposed(design), design), transposed(design));
  std::vector<Matrix3Xd> fitted(static_cast<std::size_t>(targets) + 1, Matrix3Xd::Zero(3, vertices));
  for (Index f = 0; f < frames.cols(); ++f) {
    const Matrix3Xd normal = vertex_normals(as_vertices(frames.col(f)), triangle);
    for (Index k = 0; k <= targets; ++k) fitted[static_cast<std::size_t>(k)] += solve(k, f) * normal;
  }
  surface.normal.resize(3, vertices);
  for (Index v = 0; v < vertices; ++v) {
    const double length = fitted[0].col(v).norm();
    const bool opposed = length < 0.05;  // the vertex turned right round, so its mean is arbitrary
    surface.normal.col(v) =
        opposed ? Eigen::Vector3f::UnitY() : Eigen::Vector3f((fitted[0].col(v) / length).cast<float>());
    for (Index k = 0; k < targets; ++k) {
      auto& change = surface.target[static_cast<std::size_t>(k)].normal;
      if (opposed) {
        change.col(v).setZero();
      } else {
        change.col(v) = (fitted[static_cast<std::size_t>(k) + 1].col(v) / length).cast<float>();
      }
    }
  }
}

/// Moves the base shape to the lowest weights and scales targets, so that weights are 0 to 1: Blender limits negative
/// ones.
void make_weights_positive(MorphedSurface& surface) {
  for (std::size_t k = 0; k < surface.target.size(); ++k) {
    float low = surface.weight.front()[k], high = low;
    for (const auto& weights : surface.weight) {
      low = std::min(low, weights[k]);
      high = std::max(high, weights[k]);
    }
    const float range = high - low;
    surface.position += low * surface.target[k].position;
    surface.normal += low * surface.target[k].normal;
    surface.target[k].position *= range;
    surface.target[k].normal *= range;
    for (auto& weights : surface.weight) weights[k] = (weights[k] - low) / range;
  }
  for (Index v = 0; v < surface.normal.cols(); ++v) {
    const float length = surface.normal.col(v).norm();
    const bool vanishes = length < 0.05F;
    surface.normal.col(v) = vanishes ? Eigen::Vector3f::UnitY() : Eigen::Vector3f(surface.normal.col(v) / length);
    for (MorphTarget& target : surface.target) target.normal.col(v) *= vanishes ? 0 : 1 / length;
  }
}

void measure(const MatrixXd& frames, MorphedSurface& surface) {
  double largest = 0, sum = 0;
  for (Index f = 0; f < frames.cols(); ++f) {
    Matrix3Xd error = as_vertices(frames.col(f)) - surface.position.cast<double>();
    for (std::size_t k = 0; k < surface.target.size(); ++k) {
      const auto weight = static_cast<double>(surface.weight[static_cast<std::size_t>(f)][k]);
      error -= weight * surface.target[k].position.cast<double>();
    }
    largest = std::max(largest, error.colwise().squaredNorm().maxCoeff());
    sum += error.squaredNorm();
  }
  surface.max_error_m = std::sqrt(largest);
  surface.rms_error_m = std::sqrt(sum * 3.0 / static_cast<double>(frames.size()));
}

}  // namespace

MorphedSurface morph_targets(const MatrixXd& frames, const std::vector<std::uint32_t>& triangle, int max_targets,
                             double tolerance_m) {
  MorphedSurface surface;
  const VectorXd mean = frames.rowwise().mean();
  surface.position = as_vertices(mean).cast<float>();
  MatrixXd rest = frames.colwise() - mean;  // the rest that the shapes so far do not explain
  MatrixXd weight(frames.cols(), 0);
  if (max_targets > 0 && largest_vertex(rest) >= tolerance_m) {
    const MatrixXd shapes = principal_shapes(rest, max_targets);
    for (Index k = 0; k < shapes.cols() && largest_vertex(rest) >= tolerance_m; ++k) {
      VectorXd along = transposed_product(rest, shapes.col(k));
      add_outer(rest, -1, shapes.col(k), along);
      Index peak = 0;
      double scale = along.cwiseAbs().maxCoeff(&peak);
      if (along(peak) < 0) scale = -scale;
      MorphTarget target;
      target.position = as_vertices(shapes.col(k) * scale).cast<float>();
      target.normal.setZero(3, target.position.cols());
      surface.target.push_back(std::move(target));
      weight.conservativeResize(Eigen::NoChange, k + 1);
      weight.col(k) = along / scale;
    }
  }
  for (Index f = 0; f < frames.cols(); ++f) {
    auto& keys = surface.weight.emplace_back();
    for (Index k = 0; k < weight.cols(); ++k) keys.push_back(static_cast<float>(weight(f, k)));
  }
  fit_normals(frames, triangle, weight, surface);
  make_weights_positive(surface);
  measure(frames, surface);
  return surface;
}

}  // namespace mobil::inline v0_3
