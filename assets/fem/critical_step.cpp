#include "assets/fem/critical_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "assets/fem/top_eigenvalue.h"

namespace mobil {
namespace {

std::vector<bool> moving_components(const Cells& cells, FarEnd end) {
  std::vector<bool> moving(3 * node_count(cells));
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) moving[3 * n + c] = moves(cells, end, n, c);
  }
  return moving;
}

StencilPencil make_pencil(const StiffnessTerms& terms, double across, double along, const StepCase& step_case) {
  const Cells& cells = terms.cells;
  StencilPencil pencil{
      cells, std::vector<std::array<double, 9>>(terms.pair.size()), {}, moving_components(cells, step_case.end)};
  const bool consistent = step_case.mass == Mass::consistent;
  if (consistent) pencil.mass.resize(terms.pair.size());
  const double foundation = step_case.foundation_1_s * step_case.foundation_1_s;
  const double scale = 1 / (across * across * along);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const std::size_t at = n * stencil_size + slot;
      const auto b = stiffness_block(terms.pair[at], across, along);
      const double weight = 1 / std::sqrt(terms.lumped_mass_kg[n] * terms.lumped_mass_kg[m]);
      double mass = n == m ? 1 : 0;
      if (consistent) mass = pencil.mass[at] = weight * terms.consistent_mass_kg[at];
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          if (!pencil.moving[3 * n + r] || !pencil.moving[3 * m + c]) continue;
          pencil.stiffness[at][3 * r + c] = scale * weight * b[3 * r + c] + (r == c && r < 2 ? foundation * mass : 0);
        }
      }
    });
  });
  return pencil;
}

double top_eigenvalue(const StiffnessTerms& terms, double across, double along, const StepCase& step_case) {
  return top_eigenvalue_bound(make_pencil(terms, across, along, step_case));
}

/// How far, in parts of itself, a convex h(r) may lie below its chord from entry i to the next: it is above the chords
/// on either side, prolonged. Beyond the table's ends it grows no slower than a constant and no faster than r² (as an
/// even convex function of r, and over r² one of 1/r).
double slack_between(const std::vector<double>& r, const std::vector<double>& h, std::size_t i) {
  const auto slope = [&](std::size_t from) { return (h[from + 1] - h[from]) / (r[from + 1] - r[from]); };
  const double before = i > 0 ? slope(i - 1) : 0;
  const double after = i + 2 < r.size() ? slope(i + 1) : 2 * h[i + 1] / r[i + 1];
  if (after <= before) return 0;
  return (slope(i) - before) * (after - slope(i)) / (after - before) * (r[i + 1] - r[i]) / h[i];
}

}  // namespace

double central_difference_limit(double top_1_s2, double stiffness_damping_s) {
  if (top_1_s2 <= 0) return std::numeric_limits<double>::infinity();
  const double omega = std::sqrt(top_1_s2), xi = 0.5 * stiffness_damping_s * omega;
  return 2 / (omega * (std::sqrt(1 + xi * xi) + xi));
}

double critical_step(const StiffnessTerms& terms, double across, double along, const StepCase& step_case) {
  return central_difference_limit(top_eigenvalue(terms, across, along, step_case), step_case.stiffness_damping_s);
}

CriticalSteps tabulate_critical_steps(const StiffnessTerms& terms, const StepCase& step_case, double lowest,
                                      double highest) {
  CriticalSteps table;
  table.stiffness_damping_s = step_case.stiffness_damping_s;
  table.foundation_1_s2 = step_case.foundation_1_s * step_case.foundation_1_s;
  StepCase bare = step_case, braced = step_case;
  bare.foundation_1_s = 0;
  const auto insert = [&](std::size_t place, double r) {
    const auto at = static_cast<std::ptrdiff_t>(place);
    table.ratio.insert(table.ratio.begin() + at, r);
    // at S = r, l = 1: K / (S²·l) = (A + r·B + r²·C) / r², so h = r²·ω²
    table.top.insert(table.top.begin() + at, r * r * top_eigenvalue(terms, r, 1, bare));
    if (table.foundation_1_s2 <= 0) return;
    braced.foundation_1_s = CriticalSteps::braced_across * step_case.foundation_1_s / r;
    table.braced_top.insert(table.braced_top.begin() + at, r * r * top_eigenvalue(terms, r, 1, braced));
  };
  const double intervals = highest > lowest ? std::ceil(std::log(highest / lowest) / std::log(1.12)) : 0;
  for (double i = 0; i <= intervals; ++i) {
    insert(table.ratio.size(), intervals > 0 ? lowest * std::pow(highest / lowest, i / intervals) : lowest);
  }
  constexpr std::size_t most = 400;
  for (bool settled = false; !settled && table.ratio.size() < most;) {
    settled = true;
    for (std::size_t i = table.ratio.size() - 1; i-- > 0;) {
      const bool tight = slack_between(table.ratio, table.top, i) < 0.015 &&
                         (table.braced_top.empty() || slack_between(table.ratio, table.braced_top, i) < 0.015);
      if (tight) continue;
      insert(i + 1, std::sqrt(table.ratio[i] * table.ratio[i + 1]));
      settled = false;
    }
  }
  return table;
}

Result<double> critical_step(const CriticalSteps& table, double across, double along) {
  const double r = across / along;
  constexpr double slack = 1e-6;  // individuals' scales are single precision
  if (!(across > 0 && along > 0 && r >= table.ratio.front() * (1 - slack) && r <= table.ratio.back() * (1 + slack))) {
    return fail(
        fmt::format("belly scaled {} across and {} along: their ratio {:.3g} must lie between {:.3g} and {:.3g}",
                    across, along, r, table.ratio.front(), table.ratio.back()));
  }
  std::size_t upper = 0;
  while (upper + 1 < table.ratio.size() && r > table.ratio[upper]) ++upper;
  const std::size_t lower = upper > 0 ? upper - 1 : 0;
  const double width = table.ratio[upper] - table.ratio[lower];
  const double s = width > 0 ? (r - table.ratio[lower]) / width : 0;
  const auto at = [&](const std::vector<double>& top) { return top[lower] + s * (top[upper] - top[lower]); };
  double top = at(table.top);
  if (table.foundation_1_s2 > 0) {
    const double q = across * across * table.foundation_1_s2;
    const double braced = table.braced_across * table.braced_across * table.foundation_1_s2;
    top += q < braced ? q / braced * (at(table.braced_top) - top) : at(table.braced_top) - top + q - braced;
  }
  // K / (S²·l·M₁) at (S, l): l·(A + r·B + r²·C) / (S²·l)
  return (1 - 4 * slack) * central_difference_limit(top / (across * across), table.stiffness_damping_s);
}

std::uint32_t substeps_within(double critical_step_s, double tick_s) {
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(tick_s / (0.9 * critical_step_s))));
}

}  // namespace mobil
