#include "assets/fem/belly_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <mobil/engine/interrupt.h>

namespace mobil::inline v0_3 {
namespace {

/// A symmetric matrix and then its Cholesky factor: column c's entries at and below the diagonal, `reach` + 1 of them.
struct Band {
  std::size_t size, reach;
  std::vector<double> entry;

  Band(std::size_t rows, std::size_t half_width) : size(rows), reach(half_width), entry(rows * (half_width + 1)) {}
  double* column(std::size_t c) { return entry.data() + c * (reach + 1); }
  double at(std::size_t row, std::size_t c) const { return row - c > reach ? 0 : entry[c * (reach + 1) + row - c]; }

  /// Factorises in place; returns false if the matrix is not positive definite.
  bool factorise() {
    for (std::size_t c = 0; c < size; ++c) {
      check_interrupt();
      double* const own = column(c);
      if (!(own[0] > 0)) return false;
      const std::size_t below = std::min(reach, size - 1 - c);
      const double pivot = std::sqrt(own[0]);
      for (std::size_t i = 0; i <= below; ++i) own[i] = i == 0 ? pivot : own[i] / pivot;
      for (std::size_t i = 1; i <= below; ++i) {
        const double factor = own[i];
        if (factor == 0) continue;
        double* const other = column(c + i);
        for (std::size_t r = i; r <= below; ++r) other[r - i] -= factor * own[r];
      }
    }
    return true;
  }
};

/// Critical steps per step beyond which the slowest vibrations turn half a turn a step and the error of three sweeps
/// feeds itself. At 250 it adds half within a thousand undamped steps, at 2500 and more two- to twentyfold. A step with
/// δ = B·residual keeps its measure of energy for any symmetric B ≤ (1 + 4/(ωΔt)²)·operator⁻¹ and grows beyond. Such
/// steps take eight sweeps, and a correction below 1 by more than single-precision rounding.
constexpr double many_critical_steps = 25;

/// Operator of the solver: mass_factor·M per component + stiffness_factor·K.
struct Operator {
  std::array<double, 3> mass_factor{};
  double stiffness_factor = 0;
};

double mass_of_pair(const StiffnessTerms& terms, Mass mass, std::uint32_t node, std::uint32_t other, std::size_t slot) {
  if (mass == Mass::consistent) return terms.consistent_mass_kg[node * stencil_size + slot];
  return node == other ? terms.lumped_mass_kg[node] : 0;
}

double foundation(const MuscleOptions& options) {
  const double circular = 2 * std::numbers::pi * options.foundation_hz;
  return circular * circular;
}

/// Returns the maximum difference of two neighbours' numbers.
std::size_t node_reach(const Cells& cells) {
  return std::size_t{plane_nodes(cells)} + (cells[0] + 1) + 1;
}

/// Fills rows of the moving planes with `components` a node. Components that do not move get an uncoupled row.
Band make_band(const MuscleTemplate& muscle, Mass mass, const Operator& what, double across, double along,
               BandFactor& factor) {
  const StiffnessTerms& terms = muscle.terms;
  const Cells& cells = terms.cells;
  const FarEnd end = muscle.options.far_end;
  const std::size_t width = factor.components;
  const double mass_scale = across * across * along;
  Band band(factor.nodes * width, std::min(node_reach(cells) * width + width - 1, factor.nodes * width));
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    if (n < factor.first_node || n >= factor.first_node + factor.nodes) return;
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      if (m < n || m >= factor.first_node + factor.nodes) return;
      const auto stiffness = stiffness_block(terms.pair[n * stencil_size + slot], across, along);
      const double inertia = mass_scale * mass_of_pair(terms, mass, n, m, slot);
      for (std::size_t c = 0; c < width; ++c) {
        for (std::size_t e = 0; e < width; ++e) {
          const std::size_t column = (n - factor.first_node) * width + c, row = (m - factor.first_node) * width + e;
          if (row < column) continue;
          double value = what.stiffness_factor * stiffness[3 * c + e] + (c == e ? what.mass_factor[c] * inertia : 0);
          if (width == 3 && !(moves(cells, end, n, c) && moves(cells, end, m, e))) value = row == column ? 1 : 0;
          band.column(column)[row - column] = value;
        }
      }
    });
  });
  return band;
}

/// Writes the factor in the order in which the kernels read it.
void write_factor(const Band& band, const Cells& cells, FarEnd end, BandFactor& factor) {
  const std::size_t width = factor.components, reach = node_reach(cells);
  const auto coupled = [&](std::size_t n, std::size_t m) {  // m below n
    for (std::size_t c = 0; c < width; ++c) {
      for (std::size_t e = 0; e < width; ++e) {
        if (band.at(n * width + c, m * width + e) != 0) return true;
      }
    }
    return false;
  };
  for (std::size_t n = 0; n < factor.nodes; ++n) {
    std::size_t first = n - std::min(n, reach), last = std::min<std::size_t>(factor.nodes - 1, n + reach);
    while (first < n && !coupled(n, first)) ++first;
    while (last > n && !coupled(last, n)) --last;
    factor.before.push_back(static_cast<std::uint32_t>(n - first));
    factor.after.push_back(static_cast<std::uint32_t>(last - n));
    for (std::size_t m = first; m < n; ++m) {
      for (std::size_t c = 0; c < width; ++c) {
        for (std::size_t e = 0; e < width; ++e) {
          factor.forward.push_back(static_cast<float>(band.at(n * width + c, m * width + e)));
        }
      }
    }
    const auto own = [&](std::size_t c, std::size_t e) { return band.at(n * width + c, n * width + e); };
    if (width == 1) {
      factor.inverse_diagonal.push_back(static_cast<float>(1 / own(0, 0)));
      continue;
    }
    const double xx = 1 / own(0, 0), yy = 1 / own(1, 1), zz = 1 / own(2, 2);
    const double yx = -own(1, 0) * xx * yy, zy = -own(2, 1) * yy * zz;
    const double zx = -(own(2, 0) * xx + own(2, 1) * yx) * zz;
    const auto node = static_cast<std::uint32_t>(n) + factor.first_node;
    const double x = moves(cells, end, node, 0) ? 1 : 0, y = moves(cells, end, node, 1) ? 1 : 0;
    for (const double word : {x * xx, y * yx, y * yy, zx, zy, zz}) {
      factor.inverse_diagonal.push_back(static_cast<float>(word));
    }
  }
  for (std::size_t n = factor.nodes; n-- > 0;) {
    for (std::size_t m = n + factor.after[n]; m > n; --m) {
      for (std::size_t c = 0; c < width; ++c) {
        for (std::size_t e = 0; e < width; ++e) {
          factor.backward.push_back(static_cast<float>(band.at(m * width + e, n * width + c)));
        }
      }
    }
  }
}

/// Sums rows of the mass matrix for the loads of the frame and of a held far face.
void write_mass_sums(const MuscleTemplate& muscle, BellySolver& solver) {
  const Cells& cells = muscle.terms.cells;
  solver.moment_kg_m.assign(nodal_width(cells), 0);
  solver.far_mass_kg.assign(plane_nodes(cells), 0);
  const std::uint32_t far = first_insertion_node(cells);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    std::array<double, 3> moment{};
    double far_mass = 0;
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const double mass = mass_of_pair(muscle.terms, solver.mass, n, m, slot);
      const auto& p = muscle.mesh.node[m];
      moment[0] += mass * p.x;
      moment[1] += mass * p.y;
      moment[2] += mass * p.z;
      if (m >= far) far_mass += mass;
    });
    for (std::size_t c = 0; c < 3; ++c) solver.moment_kg_m[3 * std::size_t{n} + c] = static_cast<float>(moment[c]);
    if (k + 1 == cells[2]) solver.far_mass_kg[n % plane_nodes(cells)] = static_cast<float>(far_mass);
  });
}

Result<void> check(const MuscleTemplate& muscle, Method method, double dt_s, double across, double along) {
  if (method == Method::explicit_central || method > Method::newmark)
    return fail("only static, implicit-central and newmark solve with a factor: take one of those");
  if (method != Method::statics && !(dt_s >= 1e-9 && dt_s <= 100)) {
    return fail(fmt::format("a solver's step of {} s must lie between 1e-9 and 100", dt_s));
  }
  for (const double scale : {across, along}) {
    if (!(scale >= 1e-3 && scale <= 1e3)) {
      return fail(fmt::format("a solver's body scaled by {} must lie between 0.001 and 1000", scale));
    }
  }
  const MuscleOptions& options = muscle.options;
  const double ratio = across / along;
  if (!(ratio >= options.lowest_ratio * (1 - 1e-9) && ratio <= options.highest_ratio * (1 + 1e-9))) {
    return fail(fmt::format("a solver's ratio of scales {} must lie within its template's {} to {}", ratio,
                            options.lowest_ratio, options.highest_ratio));
  }
  return {};
}

}  // namespace

Result<void> check_belly_solver(const Cells& cells, Method method) {
  const std::size_t width = method == Method::implicit_central ? 1 : 3;
  const std::size_t size = (node_count(cells) - plane_nodes(cells)) * width * (node_reach(cells) + 1) * width;
  if (size <= largest_band_factor) return {};
  return fail(
      fmt::format("an implicit solver of {}x{}x{} cells would hold {} numbers, more than {}: take fewer cells"
                  " across, or the explicit method",
                  cells[0], cells[1], cells[2], size, largest_band_factor));
}

Result<BellySolver> make_belly_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s,
                                      double across, double along) {
  if (auto ok = check(muscle, method, dt_s, across, along); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_belly_solver(muscle.terms.cells, method); !ok) return tl::unexpected(ok.error());
  const MuscleOptions& options = muscle.options;
  const Cells& cells = muscle.terms.cells;
  BellySolver solver;
  solver.method = method;
  solver.mass = method == Method::implicit_central ? Mass::consistent : mass;
  solver.dt_s = method == Method::statics ? 0 : dt_s;
  solver.across = across;
  solver.along = along;
  Operator what;
  const double sideways = foundation(options);
  switch (method) {
    case Method::explicit_central:
    case Method::modal:
    case Method::none:
    case Method::finite:
      break;
    case Method::statics:
      what = {{sideways, sideways, 0}, 1};
      solver.sweeps = 5;
      break;
    case Method::implicit_central:
      what = {{1, 0, 0}, 0};
      solver.across = solver.along = 1;
      solver.factor.components = 1;
      break;
    case Method::newmark: {
      const double inertia = 2 / dt_s + options.damping_per_s;
      what = {{inertia + dt_s / 2 * sideways, inertia + dt_s / 2 * sideways, inertia},
              dt_s / 2 + options.stiffness_damping_s};
      CriticalSteps undamped = muscle.critical_steps;
      undamped.stiffness_damping_s = 0;
      const auto critical = critical_step(undamped, across, along);
      if (critical && dt_s > many_critical_steps * *critical) {
        solver.sweeps = 8;
        solver.correction = 1 - 0x1p-16F;
      }
      break;
    }
  }
  BandFactor& factor = solver.factor;
  factor.first_node = plane_nodes(cells);
  factor.nodes =
      (options.far_end == FarEnd::held ? first_insertion_node(cells) : node_count(cells)) - factor.first_node;
  if (factor.nodes > 0) {
    Band band = make_band(muscle, solver.mass, what, solver.across, solver.along, factor);
    if (!band.factorise()) return fail("the belly's operator has no factor: its material is too near incompressible");
    write_factor(band, cells, options.far_end, factor);
  }
  write_mass_sums(muscle, solver);
  return solver;
}

}  // namespace mobil::inline v0_3
