#include "assets/reduction/modal_training.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <mobil/engine/interrupt.h>
#include "assets/reduction/dense.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Root mean squares of the inputs, and of the changes of their rates in a tick of 1/60 s. They are of three walks (0.9,
// 1.4 and 2.0 m/s) of the groups' muscles of a person of 1.80 m and 80 kg.
constexpr double tick_s = 1.0 / 60;
constexpr double walk_kick_m_s = 0.084;
constexpr std::array<double, frame_inputs> frame_rms = {1.6, 8, 11, 0.3, 4.1, 2.9, 4.2, 12.9, 33, 2.9, 33, 12.8};
constexpr std::array<double, frame_inputs> frame_kick = {39, 362, 123, 2, 159, 156, 158, 117, 1627, 158, 1628, 116};

// Vectors of a Krylov space that holds the motion of a walk. One body alone, whose 32 modes should be exact, has more
// (triceps surae: 2.2 % of its motion missing with 40, 1.6 % with 80, the limit of 32 modes).
constexpr Index min_depth = 6, krylov_vectors = 40, krylov_vectors_alone = 80;

/// Returns the lower Cholesky factor of a Gram matrix without the rows of dependent columns; `kept` has the others'
/// numbers. `least` is the minimum square of a column above rounding.
MatrixXd gram_factor(const MatrixXd& gram, const VectorXd& least, std::vector<Index>& kept) {
  constexpr double min_share = 1e-14;  // of a column's square that is its own
  MatrixXd factor = MatrixXd::Zero(gram.rows(), gram.cols());
  kept.clear();
  for (Index row = 0; row < gram.rows(); ++row) {
    const auto own = static_cast<Index>(kept.size());
    double rest = gram(row, row);
    for (Index c = 0; c < own; ++c) {
      double entry = gram(row, kept[static_cast<std::size_t>(c)]);
      for (Index k = 0; k < c; ++k) entry -= factor(own, k) * factor(c, k);
      factor(own, c) = entry / factor(c, c);
      rest -= factor(own, c) * factor(own, c);
    }
    if (!(rest > min_share * gram(row, row) && rest > least(row))) {
      factor.row(own).setZero();
      continue;
    }
    factor(own, own) = std::sqrt(rest);
    kept.push_back(row);
  }
  const auto size = static_cast<Index>(kept.size());
  return factor.topLeftCorner(size, size);
}

/// Vibrations in a space of a few fields: ω² and the fields.
struct Vibrations {
  VectorXd omega2;
  Columns shape;
  Columns mass_shape;
};

Vibrations vibrations(const Training& training, const MovingOperator& inverse, const OperatorMix& stiffness,
                      Columns start) {
  const StiffnessTerms& terms = training.terms;
  const Index block = start.cols();
  const Index enough = training.options.ratio_width > 1 ? krylov_vectors : krylov_vectors_alone;
  const Index depth = std::max(min_depth, (enough + block - 1) / block);
  Columns space(start.rows(), depth * block), mass_space(start.rows(), depth * block);
  Index size = 0, moving = 0;
  for (Index step = 0; step < depth && start.cols() > 0 && (step == 0 || size < moving); ++step) {
    check_interrupt();
    Columns next = start;
    hold(terms.cells, training.options.far_end, next);
    if (step == 0) moving = (next.rowwise().squaredNorm().array() > 0).count();  // more are rounding errors
    const Columns mass_next = orthonormalise(terms, space.leftCols(size), mass_space.leftCols(size), next);
    const Index added = std::min(next.cols(), moving - size);
    space.middleCols(size, added) = next.leftCols(added);
    mass_space.middleCols(size, added) = mass_next.leftCols(added);
    size += added;
    // a held face's own mass contributes at first
    start = step == 0 ? mass_times(terms, start) : mass_next;
    inverse.solve(start);
  }
  const auto basis = space.leftCols(size);
  const SymmetricEigen eigen = symmetric_eigen(inner(basis, applied(terms, stiffness, basis)));
  return {eigen.values, columns_product(basis, eigen.vectors),
          columns_product(mass_space.leftCols(size), eigen.vectors)};
}

/// E[y·yᵀ] of ÿ_j + α·ẏ_j + ω_j²·y_j = white noise of covariances `push`.
MatrixXd position_gramian(const VectorXd& omega2, double damping_per_s, const MatrixXd& push) {
  MatrixXd gramian = push;
  for (Index k = 0; k < push.cols(); ++k) {
    for (Index j = 0; j < push.rows(); ++j) {
      const double apart = omega2(j) - omega2(k), sum = omega2(j) + omega2(k);
      gramian(j, k) *= 2 * damping_per_s / (apart * apart + 2 * damping_per_s * damping_per_s * sum);
    }
  }
  return gramian;
}

}  // namespace

Columns orthonormalise(const StiffnessTerms& terms, const Eigen::Ref<const Columns>& basis,
                       const Eigen::Ref<const Columns>& mass_basis, Columns& fields) {
  Columns mass_fields = mass_times(terms, fields);
  std::vector<Index> kept;
  for (int round = 0; round < 2; ++round) {  // one round leaves the rounding of the others
    VectorXd least = VectorXd::Zero(fields.cols());
    if (basis.cols() > 0) {
      const MatrixXd others = inner(mass_basis, fields);
      subtract_product(fields, basis, others);
      subtract_product(mass_fields, mass_basis, others);
      least = 1e-20 * others.colwise().squaredNorm().transpose();
    }
    const MatrixXd factor = gram_factor(inner(fields, mass_fields), least, kept);
    Columns chosen(fields.rows(), factor.cols()), mass_chosen(fields.rows(), factor.cols());
    for (std::size_t c = 0; c < kept.size(); ++c) {
      chosen.col(static_cast<Index>(c)) = fields.col(kept[c]);
      mass_chosen.col(static_cast<Index>(c)) = mass_fields.col(kept[c]);
    }
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(chosen);
    factor.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(mass_chosen);
    fields = std::move(chosen);
    mass_fields = std::move(mass_chosen);
  }
  return mass_fields;
}

Result<TrainedBody> train(const Training& training, double across, double along) {
  const ModalBasisOptions& o = training.options;
  const StiffnessTerms& terms = training.terms;
  const bool held = o.far_end == FarEnd::held;
  check_interrupt();
  const OperatorMix stiffness = stiffness_over_mass(across, along, training.foundation_1_s2);
  const MovingOperator inverse(terms, o.far_end, stiffness);
  if (!inverse.positive_definite()) return fail("the mesh's stiffness is not positive definite; check its material");

  // Displacements at rest under 1 of each input, and the pulls that cause them.
  const Index ends = o.far_end == FarEnd::free ? 3 : 1, inputs = ends + (o.frame_loads ? Index{frame_inputs} : 0);
  Columns rest(3 * static_cast<Index>(node_count(terms.cells)), inputs);
  if (held) {
    rest.leftCols(1) = -applied(terms, stiffness, far_step(terms.cells));
  } else {
    rest.leftCols(ends) = far_traction(training.mesh, ends == 3) / (across * across * along);
  }
  if (o.frame_loads) {
    rest.rightCols(Index{frame_inputs}) = mass_times(terms, frame_fields(training.mesh, across, along));
  }
  const Columns pull = held ? Columns() : Columns(rest.leftCols(ends));
  inverse.solve(rest);
  if (held) rest.leftCols(1) += far_step(terms.cells);

  // A pull stretches (or bends) a belly as much as walking does.
  VectorXd size(inputs), kick(inputs);
  for (Index i = 0; i < ends; ++i) {
    const double moved = held ? 1 : inner(rest.col(i), pull.col(i))(0, 0) * across * across * along;
    size(i) = walk_stretch_m / moved;
    kick(i) = walk_kick_m_s / moved;
  }
  for (Index i = ends; i < inputs; ++i) {
    size(i) = frame_rms[static_cast<std::size_t>(i - ends)];
    kick(i) = frame_kick[static_cast<std::size_t>(i - ends)];
  }

  const Vibrations v = vibrations(training, inverse, stiffness, rest);
  // A kick of an input's rate moves vibration j by its part in the displacement at rest under that input.
  const MatrixXd kicked = inner(v.shape, mass_times(terms, rest)) * kick.asDiagonal() / std::sqrt(tick_s);
  const MatrixXd gramian =
      position_gramian(v.omega2, std::max(o.damping_per_s, 1.0), product(kicked, transposed(kicked)));
  const SymmetricEigen eigen = symmetric_eigen(gramian);
  const Index columns = std::min(training.max_columns, gramian.cols());
  const VectorXd large = eigen.values.tail(columns).cwiseMax(0.0).cwiseSqrt();
  TrainedBody body;
  body.kicks = columns_product(v.shape, eigen.vectors.rightCols(columns) * large.asDiagonal());
  body.lift = held ? Columns(rest.leftCols(1)) : Columns(rest.rows(), 0);
  body.statics = rest.rightCols(inputs - body.lift.cols()) * size.tail(inputs - body.lift.cols()).asDiagonal();
  return body;
}

}  // namespace mobil::inline v0_3
