#include "tests/reduction/bound/reduction_space.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "assets/reduction/reduced_training.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"

namespace mobil {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index krylov_vectors = 160, slowest = 45, least_block = 4;
constexpr double least_weight = 1e-3;  // of vibrations that nothing pulls

/// A body's answers at rest, each of energy 1, and its slowest vibrations, each as large as a unit kick of the answers
/// that pull it most leaves it.
Result<Columns> motions_of(const SpaceCase& given, double across, double along) {
  const StiffnessTerms& terms = given.terms;
  const FarEnd end = given.options.far_end;
  const OperatorMix stiffness = stiffness_over_mass(across, along, given.foundation_1_s2);
  const MovingOperator inverse(terms, end, stiffness);
  if (!inverse.positive_definite()) return fail("the mesh's stiffness is not positive definite; check its material");
  Columns rest = unit_pulls(given, across, along);
  const Columns pulls = rest;
  inverse.solve(rest);
  const Eigen::VectorXd size = inner(rest, pulls).diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  rest = rest * size.asDiagonal();
  Columns whole = rest;  // with the held face's step
  if (end == FarEnd::held) whole.col(0) += far_step(terms.cells) * size(0);

  // Vibrations that nothing pulls are in the basis's vectors too, by a little: noise makes them known.
  Columns start(rest.rows(), std::max(rest.cols(), least_block));
  std::uint32_t seed = 1;
  for (double& number : start.reshaped()) {
    seed = seed * 1664525U + 1013904223U;
    number = static_cast<double>(seed >> 8U) / 8388608.0 - 1;
  }
  inverse.solve(start);
  start.leftCols(rest.cols()) = rest;
  const Index most = std::max(krylov_vectors, 6 * start.cols());
  Columns space(start.rows(), most), mass_space(start.rows(), most);
  Index count = 0;
  for (bool first = true; start.cols() > 0 && count + start.cols() <= most; first = false) {
    const Columns mass_start = orthonormalise(terms, space.leftCols(count), mass_space.leftCols(count), start);
    space.middleCols(count, start.cols()) = start;
    mass_space.middleCols(count, start.cols()) = mass_start;
    count += start.cols();
    start = mass_start;
    if (first) start.col(0) = mass_times(terms, whole.leftCols(1));
    inverse.solve(start);
  }
  const auto basis = space.leftCols(count);
  const SymmetricEigen modes = symmetric_eigen(inner(basis, applied(terms, stiffness, basis)));
  const Index kept = std::min(slowest, count);
  const Columns shape = basis * modes.vectors.leftCols(kept);
  const MatrixXd kicked = inner(shape, mass_times(terms, whole));
  const Eigen::VectorXd weight = (kicked.rowwise().norm().array() + least_weight * kicked.norm())
                                     .matrix()
                                     .cwiseQuotient(modes.values.head(kept).cwiseMax(1e-300).cwiseSqrt());
  Columns all(rest.rows(), rest.cols() + kept);
  all << rest, shape * weight.asDiagonal();
  return all;
}

}  // namespace

Columns unit_pulls(const SpaceCase& given, double across, double along) {
  const ReducedOptions& o = given.options;
  const Index ends = o.far_end == FarEnd::free ? 3 : 1;
  Columns pulls(3 * Index{node_count(given.terms.cells)}, Index{input_count(o.far_end, o.frame_loads)});
  if (o.far_end == FarEnd::held) {
    pulls.leftCols(1) =
        -applied(given.terms, stiffness_over_mass(across, along, given.foundation_1_s2), far_step(given.terms.cells));
  } else {
    pulls.leftCols(ends) = far_traction(given.mesh, ends == 3) / (across * across * along);
  }
  if (o.frame_loads) {
    pulls.rightCols(Index{frame_inputs}) = mass_times(given.terms, frame_fields(given.mesh, across, along));
  }
  hold(given.terms.cells, o.far_end, pulls);
  return pulls;
}

Result<Columns> wider_space(const SpaceCase& given, const Columns& vectors, Index count) {
  const ReducedOptions& o = given.options;
  std::vector<double> ratios = {o.middle_ratio};
  if (o.ratio_width > 1) ratios.insert(ratios.end(), {o.middle_ratio / o.ratio_width, o.middle_ratio * o.ratio_width});
  Columns all(vectors.rows(), 0);
  for (const double ratio : ratios) {
    const auto motions = motions_of(given, std::sqrt(ratio * o.middle_product), std::sqrt(o.middle_product / ratio));
    if (!motions) return tl::unexpected(motions.error());
    Columns more(all.rows(), all.cols() + motions->cols());
    more << all, *motions;
    all = std::move(more);
  }
  const double along = std::sqrt(o.middle_product / o.middle_ratio);
  const OperatorMix middle = stiffness_over_mass(o.middle_ratio * along, along, given.foundation_1_s2);
  const Columns stiff = applied(given.terms, middle, vectors);
  const Eigen::LLT<MatrixXd> own(inner(vectors, stiff));
  all -= vectors * own.solve(inner(stiff, all));
  const SymmetricEigen modes = symmetric_eigen(inner(all, applied(given.terms, middle, all)));
  const Index real = (modes.values.array() > 1e-14 * modes.values(all.cols() - 1)).count();
  const Index extra = std::max<Index>(0, std::min(count - vectors.cols(), real));
  Columns chosen = all * modes.vectors.rowwise().reverse().leftCols(extra);
  orthonormalise(given.terms, vectors, mass_times(given.terms, vectors), chosen);
  Columns space(vectors.rows(), vectors.cols() + chosen.cols());
  space << vectors, chosen;
  return space;
}

}  // namespace mobil
