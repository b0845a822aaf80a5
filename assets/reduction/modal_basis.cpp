#include "assets/reduction/modal_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "assets/reduction/dense.h"
#include "assets/reduction/modal_belly.h"
#include "assets/reduction/modal_eigen.h"
#include "assets/reduction/modal_operators.h"
#include "assets/reduction/modal_tension.h"
#include "assets/reduction/modal_training.h"
#include "assets/reduction/symmetric_eigen.h"
#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Columns from which modes are made; more do not change the first 32.
constexpr Index pool = 192;

Result<void> check_options(const Cells& cells, const ModalBasisOptions& o) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (o.modes < 1 || o.modes > max_modes) {
    return fail(fmt::format("{} modes: 1 to {} can be had", o.modes, max_modes));
  }
  if (!within(o.foundation_hz, 0, 1000)) {
    return fail(fmt::format("foundation {} Hz must lie between 0 and 1000", o.foundation_hz));
  }
  if (!within(o.damping_per_s, 0, 1000)) {
    return fail(fmt::format("mass damping {} 1/s must lie between 0 and 1000", o.damping_per_s));
  }
  if (!within(o.middle_ratio, 0.1, 10)) {
    return fail(fmt::format("middle ratio {} of across to along must lie between 0.1 and 10", o.middle_ratio));
  }
  if (!within(o.ratio_width, 1, 4)) {
    return fail(fmt::format("ratio width {} must lie between 1 (that ratio alone) and 4", o.ratio_width));
  }
  if (!within(o.middle_product, 0.01, 100)) {
    return fail(fmt::format("middle product {} of across and along must lie between 0.01 and 100", o.middle_product));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (o.control_cells[axis] >= 1 && cells[axis] % o.control_cells[axis] == 0) continue;
    return fail(fmt::format("a mesh of {}x{}x{} cells has not all nodes of {}x{}x{}; take whole multiples", cells[0],
                            cells[1], cells[2], o.control_cells[0], o.control_cells[1], o.control_cells[2]));
  }
  if (cells[2] < 2 && o.far_end == FarEnd::held) return fail("a held belly of one layer of cells has no node to move");
  const bool even = cells[0] % 2 == 0 && cells[1] % 2 == 0 && cells[2] % 2 == 0;
  if (o.corrected && !(even && (cells[2] >= 4 || o.far_end != FarEnd::held))) {
    return fail(fmt::format("the correction needs even cells, 4 or more along, not {}x{}x{}; take such or leave it out",
                            cells[0], cells[1], cells[2]));
  }
  return {};
}

/// Products of the modes (ψ first, if any) with themselves and with the loads.
struct Projected {
  MatrixXd mass, a, b, c, foundation, tension, frame, traction;
};

HexahedralMesh widened(HexahedralMesh mesh, double ratio) {
  for (auto& node : mesh.node) node.x *= ratio, node.y *= ratio;
  return mesh;
}

Projected project(const HexahedralMesh& mesh, const StiffnessTerms& terms, double shear_pa, const ModalBasisOptions& o,
                  const Columns& fields) {
  const auto squared = [&](const OperatorMix& mix) { return inner(fields, applied(terms, mix, fields)); };
  Projected p{inner(fields, mass_times(terms, fields)),
              squared({1, 0, 0, 0, 0}),
              squared({0, 1, 0, 0, 0}),
              squared({0, 0, 1, 0, 0}),
              {},
              tension_stiffness(widened(mesh, o.middle_ratio), shear_pa, fields) / (o.middle_ratio * o.middle_ratio),
              {},
              {}};
  if (o.foundation_hz > 0) p.foundation = squared({0, 0, 0, 1, 0});
  if (o.frame_loads) p.frame = inner(fields, mass_times(terms, frame_fields(mesh, 1, 1)));
  if (o.far_end != FarEnd::held) p.traction = inner(fields, far_traction(mesh, o.far_end == FarEnd::free));
  return p;
}

/// Removes an error of second order in the cells' size, using the result of cells of twice the size.
void extrapolate(Projected& fine, const Projected& coarse) {
  const auto one = [](MatrixXd& f, const MatrixXd& c) {
    if (f.size() > 0) f += (f - c) / 3;
  };
  one(fine.mass, coarse.mass);
  one(fine.a, coarse.a);
  one(fine.b, coarse.b);
  one(fine.c, coarse.c);
  one(fine.foundation, coarse.foundation);
  one(fine.tension, coarse.tension);
  one(fine.frame, coarse.frame);
  one(fine.traction, coarse.traction);
}

/// Makes the modes (except for the first `lifts`) orthonormal in the mass, each a sum of itself and those before it.
/// Leaves out those that the mesh cannot represent.
void make_orthonormal(Projected& p, Columns& fields, Index lifts) {
  const Index all = fields.cols();
  MatrixXd turn = MatrixXd::Zero(all, all);  // upper triangular
  turn.topLeftCorner(lifts, lifts).setIdentity();
  Index kept = lifts;
  for (Index from = lifts; from < all; ++from) {
    Eigen::VectorXd v = Eigen::VectorXd::Unit(all, from);
    for (int round = 0; round < 2; ++round) {
      const Eigen::VectorXd pull = product(p.mass, v);
      for (Index c = lifts; c < kept; ++c) v -= turn.col(c).dot(pull) * turn.col(c);
    }
    const double square = v.dot(product(p.mass, v));
    if (square > 0.01 * p.mass(from, from)) turn.col(kept++) = v / std::sqrt(square);
  }
  const MatrixXd used = turn.leftCols(kept), across = transposed(used);
  for (MatrixXd* const m : {&p.mass, &p.a, &p.b, &p.c, &p.foundation, &p.tension}) {
    if (m->size() > 0) *m = product(product(across, *m), used);
  }
  for (MatrixXd* const m : {&p.frame, &p.traction}) {
    if (m->size() > 0) *m = product(across, *m);
  }
  fields = columns_product(fields, used);
}

std::vector<double> row_major(const Eigen::Ref<const MatrixXd>& m) {
  const Square rows = m;
  return {rows.data(), rows.data() + rows.size()};
}

/// Returns the mass of the fine mesh's nodes, given to the control points around them.
std::vector<double> control_masses(const StiffnessTerms& terms, const Cells& control) {
  std::vector<double> mass(node_count(control));
  for_each_node(terms.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t at[3] = {i, j, k};
    std::uint32_t cell[3];
    double part[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t step = terms.cells[axis] / control[axis];
      cell[axis] = std::min(at[axis] / step, control[axis] - 1);
      part[axis] = static_cast<double>(at[axis] - cell[axis] * step) / step;
    }
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const std::uint32_t up[3] = {corner & 1U, corner >> 1U & 1U, corner >> 2U};
      double share = terms.lumped_mass_kg[node_index(terms.cells, i, j, k)];
      for (std::size_t axis = 0; axis < 3; ++axis) share *= up[axis] == 1 ? part[axis] : 1 - part[axis];
      mass[node_index(control, cell[0] + up[0], cell[1] + up[1], cell[2] + up[2])] += share;
    }
  });
  return mass;
}

/// Returns the map from displacements of the control points to q: (Φᵀ·W·Φ)⁻¹·Φᵀ·W, N × 3·nodes.
std::vector<double> fit_of(const ModalBasis& basis) {
  const Index count = basis.modes, rows = 3 * static_cast<Index>(basis.control_weight.size());
  const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> shape(
      basis.shape.data(), rows, count + 1);
  const MatrixXd phi = shape.rightCols(count).cast<double>();
  Eigen::VectorXd weight(rows);
  for (Index row = 0; row < rows; ++row) weight(row) = basis.control_weight[static_cast<std::size_t>(row / 3)];
  const MatrixXd weighted = weight.asDiagonal() * phi;
  // Control points can be too few to distinguish all modes; parts that they cannot show are left out of every one.
  const SymmetricEigen gram = symmetric_eigen(product(transposed(phi), weighted));
  const double least = 1e-6 * gram.values(count - 1);
  const Eigen::VectorXd inverse =
      gram.values.unaryExpr([least](double value) { return value > least ? 1 / value : 0.0; });
  const MatrixXd scaled = gram.vectors * inverse.asDiagonal();
  return row_major(product(product(scaled, transposed(gram.vectors)), transposed(weighted)));
}

/// Scales of the template, across and along.
struct Scale {
  double across, along;
};
Scale scale_of(double ratio, double product) {
  return {std::sqrt(ratio * product), std::sqrt(product / ratio)};
}

/// Returns the modes, most important first, orthonormal in M₁, with the lift, if any, before them.
Result<Columns> trained_modes(const Training& given, Index lifts) {
  const ModalBasisOptions& o = given.options;
  std::vector<Scale> others;
  if (o.ratio_width > 1) {
    for (const double ratio : {o.middle_ratio / o.ratio_width, o.middle_ratio * o.ratio_width}) {
      // a foundation stiffens large bellies more
      if (given.foundation_1_s2 > 0) {
        for (const double share : {0.75, 1.35}) others.push_back(scale_of(ratio, share * o.middle_product));
      } else {
        others.push_back(scale_of(ratio, o.middle_product));
      }
    }
  }
  Training training = given;
  const auto bodies = static_cast<Index>(others.size() + 1);
  training.max_columns = pool / bodies - static_cast<Index>(input_count(o.far_end, o.frame_loads));
  const Scale middle = scale_of(o.middle_ratio, o.middle_product);
  const auto first = train(training, middle.across, middle.along);
  if (!first) return tl::unexpected(first.error());
  Columns all(first->kicks.rows(), pool);
  Index size = 0;
  const auto add = [&](const Columns& columns, double weight) {
    all.middleCols(size, columns.cols()) = weight * columns;
    size += columns.cols();
  };
  add(first->statics, 2);
  add(first->kicks, 2);
  for (const Scale& scale : others) {
    const auto body = train(training, scale.across, scale.along);
    if (!body) return tl::unexpected(body.error());
    if (lifts > 0) add(body->lift - first->lift, walk_stretch_m);
    add(body->statics, 1);
    add(body->kicks, 1);
  }
  const auto columns = all.leftCols(size);
  const SymmetricEigen gram = symmetric_eigen(inner(columns, mass_times(given.terms, columns)));
  // Smaller ones are rounding errors, and so are any beyond the number of rows that move.
  const Index moving = (columns.rowwise().squaredNorm().array() > 0).count();
  const Index real = (gram.values.array() > 1e-14 * gram.values(size - 1)).count();
  const Index count = std::min({Index{max_modes}, real, moving});
  Columns modes = columns_product(columns, gram.vectors.rowwise().reverse().leftCols(count));
  orthonormalise(given.terms, Columns(modes.rows(), 0), Columns(modes.rows(), 0), modes);
  Columns fields(modes.rows(), lifts + modes.cols());
  fields << first->lift, modes;
  return fields;
}

}  // namespace

Result<ModalBasis> basis_outline(const Cells& cells, const ModalBasisOptions& options) {
  if (auto ok = check_options(cells, options); !ok) return tl::unexpected(ok.error());
  const double circular = 2 * std::numbers::pi * options.foundation_hz;
  ModalBasis basis;
  basis.options = options;
  basis.cells = cells;
  basis.modes = options.modes;
  basis.inputs = input_count(options.far_end, options.frame_loads);
  basis.lowest_ratio = options.middle_ratio / options.ratio_width;
  basis.highest_ratio = options.middle_ratio * options.ratio_width;
  basis.foundation_1_s2 = circular * circular;
  return basis;
}

Result<ModalBasis> make_modal_basis(const HexahedralMesh& fine, const Material& material, Element element,
                                    const ModalBasisOptions& options, std::vector<double>* kept_fields) {
  auto outline = basis_outline(fine.cells, options);
  if (!outline) return tl::unexpected(outline.error());
  ModalBasis basis = std::move(*outline);
  const auto terms = assemble(fine, material, element);
  if (!terms) return tl::unexpected(terms.error());
  const Index lifts = options.far_end == FarEnd::held ? 1 : 0;
  auto fields = trained_modes({fine, *terms, options, basis.foundation_1_s2}, lifts);
  if (!fields) return tl::unexpected(fields.error());
  const double shear_pa = material.young_pa / (2 * (1 + material.poisson));
  Projected p = project(fine, *terms, shear_pa, options, *fields);
  if (options.corrected) {
    const HexahedralMesh coarse = every_other(fine);
    const auto coarse_terms = assemble(coarse, material, element);
    if (!coarse_terms) {
      return fail(fmt::format("correction by every other node: {}; leave it out", coarse_terms.error().message));
    }
    extrapolate(p, project(coarse, *coarse_terms, shear_pa, options, every_other(fine.cells, *fields)));
  }
  make_orthonormal(p, *fields, lifts);
  const Index count = fields->cols() - lifts;
  if (count < static_cast<Index>(options.modes)) {
    return fail(fmt::format("{} modes asked of a mesh of {}x{}x{} cells that has {}; ask for no more", options.modes,
                            fine.cells[0], fine.cells[1], fine.cells[2], count));
  }

  basis.modes = static_cast<std::uint32_t>(count);
  const auto own = [&](const MatrixXd& m) { return row_major(m.bottomRightCorner(count, count)); };
  basis.a = own(p.a);
  basis.b = own(p.b);
  basis.c = own(p.c);
  basis.tension = own(p.tension);
  if (p.foundation.size() > 0) basis.foundation = own(p.foundation);
  if (p.frame.size() > 0) basis.frame = row_major(p.frame.bottomRows(count));
  if (p.traction.size() > 0) basis.traction = row_major(p.traction);
  if (lifts > 0) {
    const auto shared = [&](const MatrixXd& m) { return row_major(m.col(0).tail(count)); };
    basis.lift_a = shared(p.a);
    basis.lift_b = shared(p.b);
    basis.lift_c = shared(p.c);
    basis.lift_mass = shared(p.mass);
    basis.lift_energy_a = p.a(0, 0);
    basis.lift_energy_b = p.b(0, 0);
    basis.lift_energy_c = p.c(0, 0);
    basis.lift_kinetic = p.mass(0, 0);
    if (p.foundation.size() > 0) {
      basis.lift_foundation = shared(p.foundation);
      basis.lift_energy_foundation = p.foundation(0, 0);
    }
    if (p.frame.size() > 0) basis.lift_frame = row_major(p.frame.row(0));
  }
  const Cells& control = options.control_cells;
  for_each_node(control, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const Index node = nested_node(fine.cells, control, i, j, k);
    for (Index row = 3 * node; row < 3 * node + 3; ++row) {
      if (lifts == 0) basis.shape.push_back(0);
      for (Index c = 0; c < fields->cols(); ++c) basis.shape.push_back(static_cast<float>((*fields)(row, c)));
    }
  });
  if (kept_fields != nullptr) kept_fields->assign(fields->data(), fields->data() + fields->size());
  basis.control_weight = control_masses(*terms, control);
  basis = truncated(basis, options.modes);
  for (const double ratio : {basis.lowest_ratio, options.middle_ratio, basis.highest_ratio}) {
    const Scale scale = scale_of(ratio, options.middle_product);
    if (auto belly = make_modal_belly(basis, scale.across, scale.along); !belly) {
      return tl::unexpected(belly.error());
    }
  }
  return basis;
}

namespace {

ModalBasis::Turned turned_of(const ModalBasis& basis) {
  const std::size_t n = basis.modes;
  const auto [across, along] = scale_of(basis.options.middle_ratio, basis.options.middle_product);
  const double ratio = across / along, size = across * along;
  alignas(64) double matrix[max_modes][max_modes];
  for (std::size_t i = 0; i < n * n; ++i) {
    double k = (basis.a[i] / ratio + basis.b[i] + basis.c[i] * ratio) / size;
    if (!basis.foundation.empty()) k += basis.foundation_1_s2 * basis.foundation[i];
    matrix[i / n][i % n] = k;
  }
  SmallEigen eigen;
  if (!solve_small(matrix, n, eigen)) return {};
  ModalBasis::Turned turned;
  for (std::size_t j = 0; j < n; ++j) {
    turned.vector.insert(turned.vector.end(), eigen.vector[j], eigen.vector[j] + n);
  }
  const auto turn = [&](const std::vector<double>& from, std::vector<double>& to) {
    if (from.empty()) return;
    std::vector<double> half(n * n);
    to.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < n; ++j) half[i * n + j] += eigen.vector[i][k] * from[k * n + j];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t j = 0; j < n; ++j) to[i * n + j] += half[i * n + k] * eigen.vector[j][k];
      }
    }
  };
  turn(basis.a, turned.a);
  turn(basis.b, turned.b);
  turn(basis.c, turned.c);
  turn(basis.foundation, turned.foundation);
  turn(basis.tension, turned.tension);
  return turned;
}

}  // namespace

ModalBasis truncated(const ModalBasis& basis, std::uint32_t modes) {
  const std::size_t all = basis.modes, few = std::min<std::size_t>(modes, all);
  ModalBasis cut = basis;
  cut.modes = cut.options.modes = static_cast<std::uint32_t>(few);
  const auto take = [](auto& numbers, std::size_t rows, std::size_t width, std::size_t kept) {
    if (numbers.empty()) return;
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t c = 0; c < kept; ++c) numbers[row * kept + c] = numbers[row * width + c];
    }
    numbers.resize(rows * kept);
  };
  for (auto* const square : {&cut.a, &cut.b, &cut.c, &cut.foundation, &cut.tension}) take(*square, few, all, few);
  for (auto* const row : {&cut.lift_a, &cut.lift_b, &cut.lift_c, &cut.lift_foundation, &cut.lift_mass}) {
    take(*row, 1, all, few);
  }
  if (!cut.traction.empty()) cut.traction.resize(cut.traction.size() / all * few);
  if (!cut.frame.empty()) cut.frame.resize(frame_inputs * few);
  take(cut.shape, 3 * cut.control_weight.size(), all + 1, few + 1);
  cut.fit = fit_of(cut);
  cut.turned = turned_of(cut);
  return cut;
}

}  // namespace mobil::inline v0_3
