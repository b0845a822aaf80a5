// Eigen at its best: many muscles as the columns of a matrix, single precision, one stiffness.
#include <array>

#include "demo/lab/rivals/block.h"
#include "demo/lab/rivals/timing.h"

namespace rivals {
namespace {

/// Stiffness as Eigen multiplies it with a matrix of states.
struct Sparse {
  Eigen::SparseMatrix<float, Eigen::RowMajor> k;
  explicit Sparse(const Block& block) : k(block.stiffness.cast<float>()) {}
  template <class States>
  void times(const States& u, States& out) const {
    out.noalias() = k * u;
  }
};

struct SparseColumns {
  Eigen::SparseMatrix<float, Eigen::ColMajor> k;
  explicit SparseColumns(const Block& block) : k(block.stiffness.cast<float>()) {}
  template <class States>
  void times(const States& u, States& out) const {
    out.noalias() = k * u;
  }
};

struct Dense {
  Eigen::MatrixXf k;
  explicit Dense(const Block& block) : k(Eigen::MatrixXd(block.stiffness).cast<float>()) {}
  template <class States>
  void times(const States& u, States& out) const {
    out.noalias() = k * u;
  }
};

/// Dense blocks of 27 × 81: a plane of nodes couples only to itself and its two neighbours.
struct DensePlanes {
  static constexpr int plane = 3 * nodes_a_plane;
  std::array<Eigen::MatrixXf, nodes_along - 1> row;
  explicit DensePlanes(const Block& block) {
    const Eigen::MatrixXf k = Eigen::MatrixXd(block.stiffness).cast<float>();
    for (int p = 0; p < nodes_along - 1; ++p)
      row[static_cast<std::size_t>(p)] = k.block(p * plane, first(p), plane, width(p));
  }
  static int first(int p) { return plane * std::max(p - 1, 0); }
  static int width(int p) { return plane * std::min(p + 2, nodes_along - 1) - first(p); }
  template <class States>
  void times(const States& u, States& out) const {
    for (int p = 0; p < nodes_along - 1; ++p) {
      out.middleRows(p * plane, plane).noalias() = row[static_cast<std::size_t>(p)] * u.middleRows(first(p), width(p));
    }
  }
};

template <class States>
struct Batch {
  States u, v, elastic;
  Eigen::Matrix<float, 1, Eigen::Dynamic> strength;
};

template <int columns, int order>
using States =
    Eigen::Matrix<float, columns == 0 ? Eigen::Dynamic : moving, columns == 0 ? Eigen::Dynamic : columns, order>;

template <class Operator, class S>
struct Crowd {
  const Operator& k;
  Eigen::VectorXf push, load;
  float keep;
  std::vector<Batch<S>, Eigen::aligned_allocator<Batch<S>>> batches;

  Crowd(const Operator& op, const Block& block, int columns, int count)
      : k(op),
        push((step_s / (1 + 0.5 * damping_per_s * step_s) * block.mass.cwiseInverse()).template cast<float>()),
        load(push.cwiseProduct((block.share_z + sideways * block.share_x).template cast<float>())),
        keep(static_cast<float>((1 - 0.5 * damping_per_s * step_s) / (1 + 0.5 * damping_per_s * step_s))),
        batches(static_cast<std::size_t>(count)) {
    int m = 0;
    for (auto& b : batches) {
      b.u = b.v = b.elastic = S::Zero(moving, columns);
      b.strength.resize(columns);
      for (int c = 0; c < columns; ++c) b.strength[c] = static_cast<float>(rivals::strength(m++));
    }
  }

  void tick(int first_step) {
    for (auto& b : batches) {
      for (int n = first_step; n < first_step + steps_a_tick; ++n) {
        k.times(b.u, b.elastic);
        const auto pull = static_cast<float>(pull_n(n));
        if constexpr (S::IsRowMajor) {
          for (int r = 0; r < moving; ++r) {
            b.v.row(r) = keep * b.v.row(r) - push[r] * b.elastic.row(r);
            if (r >= moving - 3 * nodes_a_plane) b.v.row(r) += pull * load[r] * b.strength;
            b.u.row(r) += static_cast<float>(step_s) * b.v.row(r);
          }
        } else {
          for (int c = 0; c < b.u.cols(); ++c) {
            b.v.col(c).array() = keep * b.v.col(c).array() - push.array() * b.elastic.col(c).array() +
                                 pull * b.strength[c] * load.array();
            b.u.col(c) += static_cast<float>(step_s) * b.v.col(c);
          }
        }
      }
    }
  }
};

/// Returns the history of muscle 0 in double precision, under the same loads.
Eigen::VectorXd expected_history(const Block& block, int steps) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(moving), v = u;
  const double half = 0.5 * damping_per_s * step_s;
  for (int n = 0; n < steps; ++n) {
    const Eigen::VectorXd force =
        strength(0) * pull_n(n) * (block.share_z + sideways * block.share_x) - block.stiffness * u;
    v = ((1 - half) * v + step_s * force.cwiseQuotient(block.mass)) / (1 + half);
    u += step_s * v;
  }
  return u;
}

constexpr int checked_steps = 31 * steps_a_tick;

template <class Operator, int columns, int order>
void add(Rival& rival, double limit_s, const std::string& name, const Block& block, const Eigen::VectorXd& expected,
         int width) {
  using S = States<columns, order>;
  const Operator op(block);
  {
    Crowd<Operator, S> crowd(op, block, width, 1);
    for (int n = 0; n < checked_steps; n += steps_a_tick) crowd.tick(n);
    const Eigen::VectorXd u = crowd.batches[0].u.col(0).template cast<double>();
    rival.check_error = std::max(rival.check_error, (u - expected).norm() / expected.norm());
    rival.far_z_m = far_mean(block, u)[0];
  }
  Crowd<Operator, S> crowd(op, block, width, muscles / width);
  int n = 0;
  rival.variants.push_back(timed(name, muscles * steps_a_tick, limit_s, [&] {
    crowd.tick(n);
    n += steps_a_tick;
  }));
}

}  // namespace

Rival eigen_batched(double limit_s) {
  const Block block = make_block(1, 1);
  Rival rival{.name = "eigen_batched", .repeats = repeats};
  const Eigen::VectorXd expected = expected_history(block, checked_steps);
  using Eigen::ColMajor, Eigen::RowMajor;
  add<Sparse, 32, RowMajor>(rival, limit_s, "sparse rows, states by row, 32 known", block, expected, 32);
  add<Sparse, 0, RowMajor>(rival, limit_s, "sparse rows, states by row, 32", block, expected, 32);
  add<Sparse, 32, ColMajor>(rival, limit_s, "sparse rows, states by column, 32 known", block, expected, 32);
  add<Sparse, 0, ColMajor>(rival, limit_s, "sparse rows, states by column, 32", block, expected, 32);
  add<SparseColumns, 32, RowMajor>(rival, limit_s, "sparse columns, states by row, 32 known", block, expected, 32);
  add<SparseColumns, 0, ColMajor>(rival, limit_s, "sparse columns, states by column, 32", block, expected, 32);
  add<Dense, 0, ColMajor>(rival, limit_s, "dense, states by column, 32", block, expected, 32);
  add<Dense, 0, RowMajor>(rival, limit_s, "dense, states by row, 32", block, expected, 32);
  add<DensePlanes, 0, ColMajor>(rival, limit_s, "dense planes, states by column, 32", block, expected, 32);
  add<DensePlanes, 0, RowMajor>(rival, limit_s, "dense planes, states by row, 32", block, expected, 32);
  add<Sparse, 16, RowMajor>(rival, limit_s, "sparse rows, states by row, 16 known", block, expected, 16);
  add<Sparse, 64, RowMajor>(rival, limit_s, "sparse rows, states by row, 64 known", block, expected, 64);
  rival.check = "muscle 0 after 248 steps against double precision, every variant";
  rival.holds = rival.check_error < 3e-5;
  return rival;
}

}  // namespace rivals
