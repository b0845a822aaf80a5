#include "tests/reduction/bound/reduction_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "assets/reduction/reduced_basis.h"
#include "assets/reduction/reduced_training.h"
#include "tests/reduction/bound/reduction_bound.h"

namespace mobil {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::uint32_t widest_space = 160;

/// Loads per unit over the mass of a body of across = along = 1, over all rows.
Columns load_terms(const SpaceCase& given) {
  const ReducedOptions& o = given.options;
  const Index held = o.far_end == FarEnd::held ? 1 : 0;
  const Columns pulls = unit_pulls(given, 1, 1);
  return pulls.rightCols(pulls.cols() - held);
}

/// The fields that the basis was made of: ψ, if there is one, and its vectors.
Result<Columns> fields_of(const StiffnessTerms& terms, const ReducedBasis& basis, std::span<const double> fields) {
  const Index rows = 3 * Index{node_count(terms.cells)}, lifts = basis.options.far_end == FarEnd::held ? 1 : 0;
  const Index wanted = lifts + Index{basis.vectors}, width = static_cast<Index>(fields.size()) / rows;
  if (terms.cells != basis.cells || width < wanted || width * rows != static_cast<Index>(fields.size())) {
    return fail(
        fmt::format("{} numbers are not the fields of {} vectors on {}x{}x{} cells; hand over those that the"
                    " basis was made with",
                    fields.size(), basis.vectors, terms.cells[0], terms.cells[1], terms.cells[2]));
  }
  const Eigen::Map<const Columns> all(fields.data(), rows, width);
  Columns used = all.leftCols(wanted);
  const auto vectors = used.rightCols(wanted - lifts);
  const MatrixXd a = inner(vectors, applied(terms, {1, 0, 0, 0, 0}, vectors));
  const Index n = vectors.cols();
  double off = 0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) off = std::max(off, std::abs(a(i, j) - basis.a[static_cast<std::size_t>(i * n + j)]));
  }
  const MatrixXd unit = inner(vectors, mass_times(terms, vectors)) - MatrixXd::Identity(n, n);
  if (!(off <= 1e-9 * a.norm()) || !(unit.norm() <= 1e-9)) {
    return fail("the fields are not those of the basis: hand over what make_reduced_basis gave with it, on this mesh");
  }
  return used;
}

}  // namespace

Result<ReductionBound> make_reduction_bound(const HexahedralMesh& fine, const Material& material, Element element,
                                            const ReducedBasis& basis, std::span<const double> fields,
                                            std::uint32_t space) {
  if (basis.options.corrected) {
    return fail("a bound is of a reduction on its mesh's own operators: make the basis without the correction");
  }
  if (space < basis.vectors || space > widest_space) {
    return fail(fmt::format("a wider space of {} vectors must have from the basis's {} to {}", space, basis.vectors,
                            widest_space));
  }
  const auto terms = assemble(fine, material, element);
  if (!terms) return tl::unexpected(terms.error());
  const auto used = fields_of(*terms, basis, fields);
  if (!used) return tl::unexpected(used.error());
  const ReducedOptions& o = basis.options;
  const SpaceCase given{fine, *terms, o, basis.foundation_1_s2};
  const Index lifts = o.far_end == FarEnd::held ? 1 : 0;
  const auto wide = wider_space(given, used->rightCols(Index{basis.vectors}), Index{space});
  if (!wide) return tl::unexpected(wide.error());
  Columns all(wide->rows(), lifts + wide->cols());
  all << used->leftCols(lifts), *wide;

  const auto made = std::make_shared<ReductionTables>();
  ReductionTables& t = *made;
  t.options = o;
  t.lowest_ratio = basis.lowest_ratio;
  t.highest_ratio = basis.highest_ratio;
  t.foundation_1_s2 = basis.foundation_1_s2;
  t.vectors = Index{basis.vectors};
  for (const double kg : terms->lumped_mass_kg) t.mass_kg += kg;
  const Columns loads = load_terms(given);
  t.order = {wide->cols(), basis.foundation_1_s2 > 0 ? 5 : 4, lifts, loads.cols()};

  const OperatorMix reference = reference_stiffness(o.middle_ratio, o.middle_product, basis.foundation_1_s2);
  const MovingOperator inverse(*terms, o.far_end, reference);
  auto constants = make_stiffness_constants(given, inverse);
  if (!constants) return tl::unexpected(constants.error());
  t.constants = *constants;

  // Terms over all rows, then what moves of them.
  Columns pulls(all.rows(), t.order.count());
  const OperatorMix mixes[] = {reference, {1, 0, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, 1}, {0, 0, 0, 1, 0}};
  MatrixXd* const products[] = {nullptr, &t.a, &t.c, &t.mass, &t.foundation};
  for (Index kind = 0; kind < t.order.kinds; ++kind) {
    const Columns pushed = applied(*terms, mixes[kind], all);
    if (products[kind] != nullptr) *products[kind] = inner(all, pushed);
    pulls.middleCols(kind * t.order.space, t.order.space) = pushed.rightCols(t.order.space);
    if (lifts > 0) pulls.col(t.order.kinds * t.order.space + kind) = pushed.col(0);
  }
  t.b = inner(all, applied(*terms, {0, 1, 0, 0, 0}, all));
  t.loads = inner(*wide, loads);
  pulls.rightCols(loads.cols()) = loads;
  hold(terms->cells, o.far_end, pulls);
  if (lifts > 0) {
    const MovingOperator mass_inverse(*terms, o.far_end, {0, 0, 0, 1, 1});
    Columns swept = pulls.middleCols(t.order.of_lift(TermOrder::mass), 1);
    const Columns pull = swept;
    mass_inverse.solve(swept);
    const double seen = inner(*wide, pull).squaredNorm(), whole = inner(swept, pull)(0, 0);
    t.unseen_square = std::max(0.0, whole - seen) + 1e-14 * whole;
  }
  Columns answers = pulls;
  answers.leftCols(t.order.space) = *wide;
  Columns rest = answers.rightCols(answers.cols() - t.order.space);
  inverse.solve(rest);
  answers.rightCols(rest.cols()) = rest;
  const auto symmetric = [](const MatrixXd& m) -> MatrixXd { return (m + m.transpose()) / 2; };
  t.stiffness_gram = symmetric(inner(answers, pulls));
  t.mass_gram = symmetric(inner(answers, mass_times(*terms, answers)));
  return ReductionBound{made};
}

}  // namespace mobil
