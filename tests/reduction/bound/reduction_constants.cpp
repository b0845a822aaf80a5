#include "tests/reduction/bound/reduction_constants.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "assets/reduction/reduced_training.h"
#include "assets/reduction/symmetric_eigen.h"

namespace mobil {
namespace {

using Eigen::Index;

OperatorMix sum(const OperatorMix& x, double factor, const OperatorMix& y) {
  return {x.a + factor * y.a, x.b + factor * y.b, x.c + factor * y.c, x.mass_across + factor * y.mass_across,
          x.mass_along + factor * y.mass_along};
}

/// Lanczos iteration's estimates, from within, of the least and greatest λ of what·x = λ·K₀·x.
std::pair<double, double> extremes(const SpaceCase& given, const MovingOperator& inverse, const OperatorMix& reference,
                                   const OperatorMix& what) {
  constexpr Index steps = 40;
  const Cells& cells = given.terms.cells;
  const Index rows = 3 * Index{node_count(cells)};
  Columns space(rows, steps), pushed(rows, steps);  // orthonormal in K₀, and K₀ times that
  Columns next(rows, 1);
  std::uint32_t seed = 1;
  for (Index i = 0; i < rows; ++i) {
    seed = seed * 1664525U + 1013904223U;
    next(i, 0) = static_cast<double>(seed >> 8U) / 8388608.0 - 1;
  }
  hold(cells, given.options.far_end, next);
  inverse.solve(next);
  Index count = 0;
  for (; count < steps; ++count) {
    double before = 0, after = 0;
    for (int round = 0; round < 2; ++round) {
      const Columns force = applied(given.terms, reference, next);
      if (round == 0) before = inner(next, force)(0, 0);
      next.noalias() -= space.leftCols(count) * inner(pushed.leftCols(count), next);
    }
    Columns force = applied(given.terms, reference, next);
    hold(cells, given.options.far_end, force);
    after = inner(next, force)(0, 0);
    if (!(after > 1e-18 * before) || !(after > 0)) break;
    const double size = 1 / std::sqrt(after);
    space.col(count) = next * size;
    pushed.col(count) = force * size;
    next = applied(given.terms, what, space.middleCols(count, 1));
    inverse.solve(next);
  }
  const Columns used = space.leftCols(count);
  const Eigen::VectorXd values = symmetric_eigen(inner(used, applied(given.terms, what, used))).values;
  return {values(0), values(count - 1)};
}

/// A number near `estimate` with mix = reference·sign·bound − sign·what positive definite: what ≤ bound·K₀ (sign 1) or
/// what ≥ bound·K₀ (sign −1).
Result<double> proven(const SpaceCase& given, const OperatorMix& reference, const OperatorMix& what, double estimate,
                      double sign) {
  constexpr int attempts = 40;
  double margin = 0.005 * std::abs(estimate) + 1e-9;
  for (int attempt = 0; attempt < attempts; ++attempt, margin *= 2) {
    const double bound = estimate + sign * margin;
    const OperatorMix rest = sum(sum({}, sign * bound, reference), -sign, what);
    if (MovingOperator(given.terms, given.options.far_end, rest).positive_definite()) return bound;
  }
  return fail("no bound of the mesh's stiffness could be proven; check its material");
}

OperatorMix slope_of(double ratio) {
  return {-1 / ratio, 0, ratio, 0, 0};
}

}  // namespace

OperatorMix reference_stiffness(double ratio, double product, double foundation_1_s2) {
  return {1 / ratio, 1, ratio, product * foundation_1_s2, 0};
}

Result<StiffnessConstants> make_stiffness_constants(const SpaceCase& given, const MovingOperator& inverse) {
  const double r = given.options.middle_ratio, p = given.options.middle_product;
  const OperatorMix reference = reference_stiffness(r, p, given.foundation_1_s2);
  if (!inverse.positive_definite()) return fail("the mesh's stiffness is not positive definite; check its material");
  const auto [low, high] = extremes(given, inverse, reference, slope_of(r));
  const auto greatest = [&](const OperatorMix& what) {
    return proven(given, reference, what, extremes(given, inverse, reference, what).second, 1);
  };
  const auto least_slope = proven(given, reference, slope_of(r), low, -1);
  const auto greatest_slope = proven(given, reference, slope_of(r), high, 1);
  const auto both = greatest({1 / r, 0, r, 0, 0});
  const auto brace = given.foundation_1_s2 > 0 ? greatest({0, 0, 0, p * given.foundation_1_s2, 0}) : Result<double>(0);
  for (const auto* const bound : {&least_slope, &greatest_slope, &both, &brace}) {
    if (!*bound) return tl::unexpected(bound->error());
  }
  StiffnessConstants made{r, p, *least_slope, *greatest_slope, *both, std::min(1.0, *brace), {r, r, r}, {}};
  const double width = given.options.ratio_width;
  for (std::size_t end = 0; end < 3; ++end) {
    made.end_ratio[end] = end == 0 ? r / width : end == 1 ? r : r * width;
    const OperatorMix stiffness = reference_stiffness(made.end_ratio[end], p, given.foundation_1_s2),
                      mass{0, 0, 0, 1, 1};
    const MovingOperator own(given.terms, given.options.far_end, stiffness);
    if (!own.positive_definite()) return fail("the mesh's stiffness is not positive definite; check its material");
    const auto bound = proven(given, stiffness, mass, extremes(given, own, stiffness, mass).second, 1);
    if (!bound) return tl::unexpected(bound.error());
    made.slowest[end] = 1 / *bound;
  }
  return made;
}

double slowest_square(const StiffnessConstants& constants, double across, double along) {
  const double size = across * along;
  const auto& ends = constants.end_ratio;
  const double r = std::clamp(across / along, ends[0], ends[2]);
  const std::size_t low = r < ends[1] ? 0 : 1;
  const double gap = ends[low + 1] - ends[low], part = gap > 0 ? (ends[low + 1] - r) / gap : 1;  // θ
  const double between = part * constants.slowest[low] + (1 - part) * constants.slowest[low + 1];
  const double curve = std::max(0.0, part / ends[low] + (1 - part) / ends[low + 1] - 1 / r);
  const double lost =
      curve * constants.ratio * constants.sum + std::max(0.0, 1 - size / constants.product) * constants.braced;
  const double least = stiffness_range(constants, across, along).least;
  return least > 0 ? between / (1 + lost / least) / size : 0;
}

StiffnessRange stiffness_range(const StiffnessConstants& constants, double across, double along) {
  const double s = std::log(across / along / constants.ratio), size = across * along / constants.product - 1;
  const double curved = std::expm1(std::abs(s)) - std::abs(s);
  StiffnessRange range;
  range.least = 1 + s * (s > 0 ? constants.low : constants.high) + std::min(0.0, size) * constants.braced;
  range.most = 1 + s * (s > 0 ? constants.high : constants.low) + curved * constants.sum +
               std::max(0.0, size) * constants.braced;
  return range;
}

}  // namespace mobil
