#include "demo/lab/reference/reference.h"

#include <fmt/format.h>

#include "engine/eigen.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "assets/fem/kernel_arrays.h"

namespace mobil {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;  // symmetric, both halves stored
using Index = Eigen::Index;
using Entries = std::vector<Eigen::Triplet<double>>;

Index row_of(std::uint32_t node, std::size_t axis) {
  return 3 * static_cast<Index>(node) + static_cast<Index>(axis);
}

/// Returns M = S²·l·M₁ of all components, kg.
Matrix mass_matrix(const StiffnessTerms& terms, const ReferenceOptions& o) {
  const double scale = o.across * o.across * o.along;
  Entries entries;
  for_each_node(terms.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(terms.cells, i, j, k);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (o.mass == Mass::lumped) {
        entries.emplace_back(row_of(n, axis), row_of(n, axis), scale * terms.lumped_mass_kg[n]);
        continue;
      }
      for_each_neighbour(terms.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
        entries.emplace_back(row_of(n, axis), row_of(m, axis),
                             scale * terms.consistent_mass_kg[n * stencil_size + slot]);
      });
    }
  });
  const auto size = 3 * static_cast<Index>(node_count(terms.cells));
  Matrix mass(size, size);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

/// Returns K = S·(A/r + B + r·C) of all components, N/m.
Matrix stiffness_matrix(const StiffnessTerms& terms, const ReferenceOptions& o) {
  Entries entries;
  for_each_node(terms.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(terms.cells, i, j, k);
    for_each_neighbour(terms.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const auto block = stiffness_block(terms.pair[n * stencil_size + slot], o.across, o.along);
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) entries.emplace_back(row_of(n, a), row_of(m, b), block[3 * a + b]);
      }
    });
  });
  const auto size = 3 * static_cast<Index>(node_count(terms.cells));
  Matrix stiffness(size, size);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

/// Returns ω_f²·M in x and y.
Matrix foundation_matrix(const Matrix& mass, double frequency_1_s) {
  Entries entries;
  for (Index column = 0; column < mass.outerSize(); ++column) {
    if (column % 3 == 2) continue;
    for (Matrix::InnerIterator entry(mass, column); entry; ++entry) {
      entries.emplace_back(entry.row(), column, frequency_1_s * frequency_1_s * entry.value());
    }
  }
  Matrix foundation(mass.rows(), mass.cols());
  foundation.setFromTriplets(entries.begin(), entries.end());
  return foundation;
}

/// Returns the rows and columns of the moving components.
Matrix of_moving(const Matrix& matrix, const std::vector<Index>& moving) {
  std::vector<Index> place(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < moving.size(); ++i) place[static_cast<std::size_t>(moving[i])] = static_cast<Index>(i);
  Entries entries;
  for (const Index column : moving) {
    for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const Index row = place[static_cast<std::size_t>(entry.row())];
      if (row >= 0) entries.emplace_back(row, place[static_cast<std::size_t>(column)], entry.value());
    }
  }
  const auto size = static_cast<Index>(moving.size());
  Matrix part(size, size);
  part.setFromTriplets(entries.begin(), entries.end());
  return part;
}

bool accelerated(const ReferenceLoad& load) {
  const auto any = [](const Vec3<double>& a) { return a.x != 0 || a.y != 0 || a.z != 0; };
  return any(load.constant) || any(load.gradient.x) || any(load.gradient.y) || any(load.gradient.z);
}

Result<void> check(const ReferenceOptions& o, const Cells& cells) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  if (!positive(o.across) || !positive(o.along)) {
    return fail(fmt::format("scales {} across and {} along must be positive and finite", o.across, o.along));
  }
  if (o.method != Method::statics && !positive(o.dt_s)) {
    return fail(fmt::format("step {} s must be positive and finite", o.dt_s));
  }
  const auto none_or_more = [](double x) { return std::isfinite(x) && x >= 0; };
  if (!none_or_more(o.damping_per_s) || !none_or_more(o.stiffness_damping_s) || !none_or_more(o.foundation_1_s)) {
    return fail(fmt::format("damping {} 1/s and {} s and foundation {} 1/s must be finite, 0 or more", o.damping_per_s,
                            o.stiffness_damping_s, o.foundation_1_s));
  }
  if (o.method > Method::newmark)
    return fail("the reference steps by static, explicit-central, implicit-central or newmark; take one of those");
  if (cells[2] < 2 && o.end == FarEnd::held) return fail("a held belly of one layer of elements has no node to move");
  return {};
}

}  // namespace

struct ReferenceBelly::State {
  HexahedralMesh mesh;
  ReferenceOptions o;
  Matrix mass, stiffness;  // of all components; the foundation K_f is part of the stiffness
  Matrix elastic;          // K, without it
  std::vector<Index> moving;
  std::vector<double> far_share;
  Eigen::SimplicialLDLT<Matrix> operator_;  // matrix of a step's equations: M, K, or CAA's
  Vector u, v, before;                      // before: displacement of the previous step

  State(const HexahedralMesh& m, const StiffnessTerms& terms, const ReferenceOptions& options);
  Vector force(const ReferenceLoad& load) const;
  Vector acceleration(const ReferenceLoad& load) const;
  Vector solve(const Vector& right_side) const { return operator_.solve(Vector(right_side(moving))); }
  bool held() const { return o.end == FarEnd::held; }
  void set_far_z(Vector& x, double value) const;
  void step_explicitly(const ReferenceLoad& now, const ReferenceLoad& next);
  void step_by_mean_acceleration(const ReferenceLoad& now, const ReferenceLoad& next);
  void settle(const ReferenceLoad& load);
};

ReferenceBelly::State::State(const HexahedralMesh& m, const StiffnessTerms& terms, const ReferenceOptions& options)
    : mesh(m), o(options), far_share(far_shares(m)) {
  if (o.method == Method::explicit_central) o.mass = Mass::lumped;
  if (o.method == Method::implicit_central) o.mass = Mass::consistent;
  const double dt = o.dt_s;
  mass = mass_matrix(terms, o);
  elastic = stiffness_matrix(terms, o);
  stiffness = elastic + foundation_matrix(mass, o.foundation_1_s);
  for (std::uint32_t n = 0; n < node_count(mesh.cells); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (moves(mesh.cells, o.end, n, axis)) moving.push_back(row_of(n, axis));
    }
  }
  switch (o.method) {
    case Method::statics:
      operator_.compute(of_moving(stiffness, moving));
      break;
    case Method::explicit_central:
    case Method::implicit_central:
      operator_.compute(of_moving(mass, moving));
      break;
    case Method::newmark:
      operator_.compute(of_moving(
          Matrix((2 / dt + o.damping_per_s) * mass + dt / 2 * stiffness + o.stiffness_damping_s * elastic), moving));
      break;
    case Method::modal:
    case Method::none:
    case Method::finite:
      break;
  }
  u = v = before = Vector::Zero(mass.rows());
}

/// Returns traction and M·a, N.
Vector ReferenceBelly::State::force(const ReferenceLoad& load) const {
  Vector f = Vector::Zero(u.size());
  if (accelerated(load)) f = mass * acceleration(load);
  if (held()) return f;
  const std::uint32_t first = first_insertion_node(mesh.cells);
  for (std::uint32_t i = 0; i < plane_nodes(mesh.cells); ++i) {
    f(row_of(first + i, 0)) += far_share[i] * load.end.x;
    f(row_of(first + i, 1)) += far_share[i] * load.end.y;
    f(row_of(first + i, 2)) += far_share[i] * load.end.z;
  }
  return f;
}

/// Returns the acceleration of every node, m/s².
Vector ReferenceBelly::State::acceleration(const ReferenceLoad& load) const {
  Vector a(u.size());
  for (std::uint32_t n = 0; n < node_count(mesh.cells); ++n) {
    const double x = o.across * mesh.node[n].x, y = o.across * mesh.node[n].y, z = o.along * mesh.node[n].z;
    const auto turn = [&](const Vec3<double>& row) { return row.x * x + row.y * y + row.z * z; };
    a(row_of(n, 0)) = load.constant.x + turn(load.gradient.x);
    a(row_of(n, 1)) = load.constant.y + turn(load.gradient.y);
    a(row_of(n, 2)) = load.constant.z + turn(load.gradient.z);
  }
  return a;
}

void ReferenceBelly::State::set_far_z(Vector& x, double value) const {
  for (std::uint32_t n = first_insertion_node(mesh.cells); n < node_count(mesh.cells); ++n) x(row_of(n, 2)) = value;
}

/// Advances ECD and ICD: M·[(1 + αΔt/2)·v⁺ − (1 − αΔt/2)·v⁻] = Δt·[f − (K + K_f)·u − β·K·v⁻], u⁺ = u + Δt·v⁺.
void ReferenceBelly::State::step_explicitly(const ReferenceLoad& now, const ReferenceLoad& next) {
  const double dt = o.dt_s, h = o.damping_per_s * dt / 2;
  if (held()) set_far_z(v, (next.end.z - u(row_of(first_insertion_node(mesh.cells), 2))) / dt);
  Vector right_side = force(now) - stiffness * u;
  if (o.stiffness_damping_s > 0) right_side -= o.stiffness_damping_s * (elastic * v);
  if (held() && o.mass == Mass::consistent && o.damping_per_s > 0) {
    Vector far = Vector::Zero(u.size());
    set_far_z(far, v(row_of(first_insertion_node(mesh.cells), 2)));
    right_side -= o.damping_per_s * (mass * far);
  }
  v(moving) = ((1 - h) * v(moving) + dt * solve(right_side)) / (1 + h);
  u += dt * v;
  if (held()) set_far_z(u, next.end.z);
}

/// Advances CAA. It solves for the change δ = w − v to the step's mean velocity, which has less rounding than w:
///   [(2/Δt + α)·M + (Δt/2)·(K + K_f) + β·K]·δ = (f + f⁺)/2 − α·M·v − β·K·v − (K + K_f)·(u + ½Δt·v),
/// u⁺ = u + Δt·(v + δ), v⁺ = v + 2δ.
void ReferenceBelly::State::step_by_mean_acceleration(const ReferenceLoad& now, const ReferenceLoad& next) {
  const double dt = o.dt_s;
  if (held()) set_far_z(v, (next.end.z - u(row_of(first_insertion_node(mesh.cells), 2))) / dt);
  Vector right_side = (force(now) + force(next)) / 2 - stiffness * (u + dt / 2 * v);
  if (o.stiffness_damping_s > 0) right_side -= o.stiffness_damping_s * (elastic * v);
  if (o.damping_per_s > 0) right_side -= o.damping_per_s * (mass * v);
  const Vector change = solve(right_side);
  u += dt * v;
  u(moving) += dt * change;
  v(moving) += 2 * change;
  if (held()) set_far_z(u, next.end.z);
}

/// Solves static: (K + K_f)·u = f.
void ReferenceBelly::State::settle(const ReferenceLoad& load) {
  u.setZero();
  if (held()) set_far_z(u, load.end.z);
  u(moving) = solve(force(load) - stiffness * u);
}

ReferenceBelly::ReferenceBelly(std::unique_ptr<State> state) : state_(std::move(state)) {}
ReferenceBelly::ReferenceBelly(ReferenceBelly&&) noexcept = default;
ReferenceBelly& ReferenceBelly::operator=(ReferenceBelly&&) noexcept = default;
ReferenceBelly::~ReferenceBelly() = default;

Result<ReferenceBelly> ReferenceBelly::make(const HexahedralMesh& mesh, const StiffnessTerms& terms,
                                            const ReferenceOptions& options) {
  if (auto ok = check(options, mesh.cells); !ok) return tl::unexpected(ok.error());
  auto state = std::make_unique<State>(mesh, terms, options);
  if (state->operator_.info() != Eigen::Success) return fail("the belly's operator has no factor; check its material");
  return ReferenceBelly(std::move(state));
}

void ReferenceBelly::start(const ReferenceLoad& load) {
  State& s = *state_;
  switch (s.o.method) {
    case Method::statics:
      s.settle(load);
      break;
    case Method::explicit_central:
    case Method::implicit_central:
      s.v(s.moving) = -s.o.dt_s / 2 * s.solve(s.force(load));
      break;
    case Method::newmark:
    case Method::modal:
    case Method::none:
    case Method::finite:
      break;
  }
}

void ReferenceBelly::step(const ReferenceLoad& now, const ReferenceLoad& next) {
  State& s = *state_;
  s.before = s.u;
  switch (s.o.method) {
    case Method::statics:
      return s.settle(next);
    case Method::explicit_central:
    case Method::implicit_central:
      return s.step_explicitly(now, next);
    case Method::newmark:
      return s.step_by_mean_acceleration(now, next);
    case Method::modal:
    case Method::none:
    case Method::finite:
      break;
  }
}

std::span<double> ReferenceBelly::displacement() {
  return {state_->u.data(), static_cast<std::size_t>(state_->u.size())};
}
std::span<double> ReferenceBelly::velocity() {
  return {state_->v.data(), static_cast<std::size_t>(state_->v.size())};
}

ReferenceReport ReferenceBelly::report() const {
  const State& s = *state_;
  const Vector inner = s.elastic * s.u;
  const bool across_a_step = s.o.method == Method::explicit_central || s.o.method == Method::implicit_central;
  ReferenceReport report{0, 0, s.v.dot(s.mass * s.v) / 2, (across_a_step ? s.before : s.u).dot(s.stiffness * s.u) / 2};
  const std::uint32_t first = first_insertion_node(s.mesh.cells);
  for (std::uint32_t i = 0; i < plane_nodes(s.mesh.cells); ++i) {
    report.reaction_n += inner(row_of(first + i, 2));
    report.elongation_m += s.far_share[i] * s.u(row_of(first + i, 2));
  }
  return report;
}

bool ReferenceBelly::finite() const {
  return state_->u.allFinite();
}

}  // namespace mobil
