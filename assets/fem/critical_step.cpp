#include "assets/fem/critical_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <mobil/engine/interrupt.h>
#include "assets/fem/top_eigenvalue.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double widest = 4;  // scale across up to which a foundation's entries are as close as they are promised

std::vector<bool> moving_components(const Cells& cells, FarEnd end) {
  std::vector<bool> moving(3 * node_count(cells));
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) moving[3 * n + c] = moves(cells, end, n, c);
  }
  return moving;
}

StencilPencil empty_pencil(const StiffnessTerms& terms, const StepCase& step_case) {
  return {terms.cells,
          std::vector<std::array<double, 9>>(terms.pair.size()),
          std::vector<double>(step_case.mass == Mass::consistent ? terms.pair.size() : 0),
          moving_components(terms.cells, step_case.end)};
}

/// Fills the result of `empty_pencil` for a belly of that scale.
void fill_pencil(const StiffnessTerms& terms, double across, double along, const StepCase& step_case,
                 StencilPencil& pencil) {
  const Cells& cells = terms.cells;
  const bool consistent = step_case.mass == Mass::consistent;
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
}

/// Returns the maximum distance of a convex h(x) below its chord from x[i] to x[i + 1]. It is above the chords on
/// either side, prolonged, whose slopes are `before` and `after`.
double sag(double before, double slope, double after, double width) {
  return after <= before ? 0 : (slope - before) * (after - slope) / (after - before) * width;
}

/// Fills the tables of CriticalSteps: h(r, q) wherever one is needed, and more arguments where h can sag too much.
class Tabulation {
 public:
  Tabulation(CriticalSteps& table, const StiffnessTerms& terms, const StepCase& step_case)
      : table_(table),
        terms_(terms),
        step_case_(step_case),
        pencil_(empty_pencil(terms, step_case)),
        start_(lanczos_start(pencil_.moving)) {}

  void insert_ratio(std::size_t place, double r) {
    for (std::size_t level = table_.foundation.size(); level-- > 0;) {
      const double h = top(r, table_.foundation[level]);
      table_.top.insert(at(level, place, table_.ratio.size()), h);
    }
    table_.ratio.insert(table_.ratio.begin() + static_cast<std::ptrdiff_t>(place), r);
  }
  void insert_foundation(std::size_t level, double q) {
    std::vector<double> row;
    for (const double r : table_.ratio) row.push_back(top(r, q));
    table_.top.insert(at(level, 0, table_.ratio.size()), row.begin(), row.end());
    table_.foundation.insert(table_.foundation.begin() + static_cast<std::ptrdiff_t>(level), q);
  }

  /// Beyond the table's ends h grows at least like a constant and at most like r² (as an even convex function of r, and
  /// over r² one of 1/r).
  bool sags_between_ratios(std::size_t i) const {
    const auto& r = table_.ratio;
    for (std::size_t level = 0; level < table_.foundation.size(); ++level) {
      const double* const h = &table_.top[level * r.size()];
      const auto slope = [&](std::size_t from) { return (h[from + 1] - h[from]) / (r[from + 1] - r[from]); };
      const double before = i > 0 ? slope(i - 1) : 0;
      const double after = i + 2 < r.size() ? slope(i + 1) : 2 * h[i + 1] / r[i + 1];
      if (sag(before, slope(i), after, r[i + 1] - r[i]) >= max_between_ratios * h[i]) return true;
    }
    return false;
  }
  /// With a foundation's stiffness h grows at a rate between 0 and 1.
  bool sags_between_foundations(std::size_t level) const {
    const auto& q = table_.foundation;
    for (std::size_t i = 0; i < table_.ratio.size(); ++i) {
      const auto h = [&](std::size_t l) { return table_.top[l * table_.ratio.size() + i]; };
      const auto slope = [&](std::size_t from) { return (h(from + 1) - h(from)) / (q[from + 1] - q[from]); };
      const double before = level > 0 ? slope(level - 1) : 0, after = level + 2 < q.size() ? slope(level + 1) : 1;
      if (sag(before, slope(level), after, q[level + 1] - q[level]) >= max_between_foundations * h(level)) return true;
    }
    return false;
  }
  /// True if h, growing as fast as it can past the last foundation, is too much at `q`.
  bool sags_beyond(double q) const {
    const std::size_t last = table_.foundation.size() - 1, n = table_.ratio.size();
    const double past = q - table_.foundation[last];
    for (std::size_t i = 0; i < n; ++i) {
      const double h = table_.top[last * n + i], slope = (h - table_.top[(last - 1) * n + i]) /
                                                         (table_.foundation[last] - table_.foundation[last - 1]);
      if ((1 - slope) * past >= max_between_foundations * (h + slope * past)) return true;
    }
    return false;
  }

 private:
  static constexpr double max_between_ratios = 0.015, max_between_foundations = 0.01;

  std::vector<double>::iterator at(std::size_t level, std::size_t place, std::size_t ratios) {
    return table_.top.begin() + static_cast<std::ptrdiff_t>(level * ratios + place);
  }
  /// At S = r, l = 1: K / (S²·l) = (A + r·B + r²·C) / r², so h = r²·ω².
  double top(double r, double q) {
    check_interrupt();
    StepCase step_case = step_case_;
    step_case.foundation_1_s = std::sqrt(q) / r;
    fill_pencil(terms_, r, 1, step_case, pencil_);
    return r * r * top_eigenvalue_bound(pencil_, start_, work_);
  }

  CriticalSteps& table_;
  const StiffnessTerms& terms_;
  const StepCase& step_case_;
  StencilPencil pencil_;
  StencilMatrix work_;
  std::vector<double> start_;
};

}  // namespace

double central_difference_limit(double top_1_s2, double stiffness_damping_s) {
  if (top_1_s2 <= 0) return std::numeric_limits<double>::infinity();
  const double omega = std::sqrt(top_1_s2), xi = 0.5 * stiffness_damping_s * omega;
  return 2 / (omega * (std::sqrt(1 + xi * xi) + xi));
}

double critical_step(const StiffnessTerms& terms, double across, double along, const StepCase& step_case) {
  StencilPencil pencil = empty_pencil(terms, step_case);
  fill_pencil(terms, across, along, step_case, pencil);
  StencilMatrix work;
  const double top = top_eigenvalue_bound(pencil, lanczos_start(pencil.moving), work);
  return central_difference_limit(top, step_case.stiffness_damping_s);
}

CriticalSteps tabulate_critical_steps(const StiffnessTerms& terms, const StepCase& step_case, double lowest,
                                      double highest) {
  CriticalSteps table;
  table.stiffness_damping_s = step_case.stiffness_damping_s;
  table.foundation_1_s2 = step_case.foundation_1_s * step_case.foundation_1_s;
  Tabulation tabulation(table, terms, step_case);
  table.foundation.push_back(0);
  const double intervals = highest > lowest ? std::ceil(exact::log(highest / lowest) / exact::log(1.12)) : 0;
  for (double i = 0; i <= intervals; ++i) {
    tabulation.insert_ratio(table.ratio.size(),
                            intervals > 0 ? lowest * exact::pow(highest / lowest, i / intervals) : lowest);
  }
  const bool founded = table.foundation_1_s2 > 0;
  const auto foundation_at = [&](double across) { return across * across * table.foundation_1_s2; };
  if (founded) {
    tabulation.insert_foundation(1, foundation_at(2));
    if (tabulation.sags_beyond(foundation_at(widest))) tabulation.insert_foundation(2, foundation_at(widest));
  }
  constexpr std::size_t max_ratios = 400, max_foundations = 16;
  for (bool settled = false; !settled;) {
    settled = true;
    for (std::size_t i = table.ratio.size() - 1; i-- > 0 && table.ratio.size() < max_ratios;) {
      if (!tabulation.sags_between_ratios(i)) continue;
      tabulation.insert_ratio(i + 1, std::sqrt(table.ratio[i] * table.ratio[i + 1]));
      settled = false;
    }
    for (std::size_t i = table.foundation.size() - 1; i-- > 0 && table.foundation.size() < max_foundations;) {
      if (!tabulation.sags_between_foundations(i)) continue;
      tabulation.insert_foundation(i + 1, 0.5 * (table.foundation[i] + table.foundation[i + 1]));
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
  const auto at = [&](std::size_t level) {
    const double* const row = &table.top[level * table.ratio.size()];
    return row[lower] + s * (row[upper] - row[lower]);
  };
  const auto& foundation = table.foundation;
  const double q = across * across * table.foundation_1_s2;
  std::size_t next = 1;
  while (next < foundation.size() && q >= foundation[next]) ++next;
  double top = at(next - 1);
  const double past = q - foundation[next - 1];
  if (next < foundation.size()) {
    top += past / (foundation[next] - foundation[next - 1]) * (at(next) - top);
  } else {
    top += past;
  }
  // K / (S²·l·M₁) at (S, l): l·(A + r·B + r²·C) / (S²·l)
  return (1 - 4 * slack) * central_difference_limit(top / (across * across), table.stiffness_damping_s);
}

std::uint32_t substeps_within(double critical_step_s, double tick_s) {
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(tick_s / (0.9 * critical_step_s))));
}

}  // namespace mobil::inline v0_3
