#pragma once
// The full model of a mesh, integrated exactly: what tests of the bound of a reduction's error compare it with.

#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_operators.h"
#include "tests/fem/oracle.h"

namespace mobil {

/// z̈ + α·ż + ω²·z = ω²·s, s linear over a tick, by the roots of its characteristic polynomial.
struct FreeOrForced {
  double omega2, damping;
  double z = 0, speed = 0;

  void step(double from, double to, double time_s) {
    const double rate = (to - from) / time_s, lag = damping / omega2 * rate;
    const std::complex<double> split = std::sqrt(std::complex<double>(damping * damping / 4 - omega2));
    const std::complex<double> root[2] = {-damping / 2 + split, -damping / 2 - split};
    const double y = z - from + lag, v = speed - rate;
    const std::complex<double> first = (v - root[1] * y) / (root[0] - root[1]), second = y - first;
    const std::complex<double> grown[2] = {first * std::exp(root[0] * time_s), second * std::exp(root[1] * time_s)};
    z = to - lag + (grown[0] + grown[1]).real();
    speed = rate + (root[0] * grown[0] + root[1] * grown[1]).real();
  }
};

class FullBelly {
 public:
  /// `fields` as make_reduced_basis hands them out.
  FullBelly(const HexahedralMesh& mesh, const StiffnessTerms& terms, const ReducedBasis& basis,
            std::span<const double> fields, double across, double along, double damping_per_s)
      : mass_scale_(across * across * along), held_(basis.options.far_end == FarEnd::held) {
    using Eigen::Index;
    const Index rows = 3 * Index{node_count(mesh.cells)};
    const FarEnd end = basis.options.far_end;
    std::vector<Index> moving;
    for (Index row = 0; row < rows; ++row) {
      if (moves(mesh.cells, end, static_cast<std::uint32_t>(row / 3), static_cast<std::size_t>(row % 3))) {
        moving.push_back(row);
      }
    }
    const Columns unit = Columns::Identity(rows, rows);
    const double r = across / along, p = across * along;
    const Columns stiffness = applied(terms, {1 / (r * p), 1 / p, r / p, basis.foundation_1_s2, 0}, unit);
    const Columns mass = applied(terms, {0, 0, 0, 1, 1}, unit);
    const Eigen::MatrixXd k = stiffness(moving, moving), m = mass(moving, moving);
    const SymmetricEigen modes = oracle::modes(k, m);
    for (const double omega2 : modes.values) vibration_.push_back({omega2, damping_per_s});
    const Eigen::MatrixXd seen = modes.vectors.transpose() * m;

    const Index inputs = Index{basis.inputs}, frame = basis.options.frame_loads ? Index{frame_inputs} : 0;
    Columns loads = Columns::Zero(rows, inputs), step = Columns::Zero(rows, 1);
    if (held_) {
      step = far_step(mesh.cells);
      loads.leftCols(1) = -stiffness * step;
    } else {
      loads.leftCols(inputs - frame) = far_traction(mesh, end == FarEnd::free) / mass_scale_;
    }
    if (frame > 0) loads.rightCols(frame) = mass * frame_fields(mesh, across, along);
    rest_ = modes.values.cwiseInverse().asDiagonal() * (modes.vectors.transpose() * loads(moving, Eigen::all));
    dragged_ = modes.vectors.transpose() * (mass * step)(moving, Eigen::all);
    if (held_) rest_.col(0) += dragged_;

    const Index width = static_cast<Index>(fields.size()) / rows;
    const Eigen::Map<const Columns> all(fields.data(), rows, width);
    const Columns used = all.leftCols((held_ ? 1 : 0) + Index{basis.vectors});
    shape_ = seen * used(moving, Eigen::all);
    for (const double kg : terms.lumped_mass_kg) mass_kg_ += kg;
  }

  void start(const std::vector<double>& input) {
    input_ = Eigen::Map<const Eigen::VectorXd>(input.data(), rest_.cols());
    const Eigen::VectorXd s = rest_ * input_;
    for (std::size_t j = 0; j < vibration_.size(); ++j) {
      vibration_[j].z = s(static_cast<Eigen::Index>(j));
      vibration_[j].speed = 0;
    }
  }
  void step(const std::vector<double>& input, double tick_s) {
    const Eigen::VectorXd from = rest_ * input_;
    input_ = Eigen::Map<const Eigen::VectorXd>(input.data(), rest_.cols());
    const Eigen::VectorXd to = rest_ * input_;
    for (std::size_t j = 0; j < vibration_.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      vibration_[j].step(from(i), to(i), tick_s);
    }
  }

  /// √J and m, as ReductionError has them.
  struct Error {
    double energy, rms_m;
  };
  Error error(const std::vector<double>& q) const {
    Eigen::VectorXd all(shape_.cols());
    if (held_) all(0) = input_(0);
    for (std::size_t i = 0; i < q.size(); ++i) all(static_cast<Eigen::Index>(i) + (held_ ? 1 : 0)) = q[i];
    Eigen::VectorXd apart = shape_ * all;
    double energy2 = 0;
    for (std::size_t j = 0; j < vibration_.size(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      apart(i) -= vibration_[j].z - (held_ ? dragged_(i) * input_(0) : 0);
      energy2 += vibration_[j].omega2 * apart(i) * apart(i);
    }
    return {std::sqrt(mass_scale_ * energy2), apart.norm() / std::sqrt(mass_kg_)};
  }
  double slowest_1_s() const { return std::sqrt(vibration_.front().omega2); }

 private:
  double mass_scale_, mass_kg_ = 0;
  bool held_;
  std::vector<FreeOrForced> vibration_;
  Eigen::MatrixXd rest_, shape_;
  Eigen::VectorXd dragged_, input_;
};

}  // namespace mobil
