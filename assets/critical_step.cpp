#include "assets/critical_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mobil {
namespace {

/// M^{-½}·K·M^{-½} of one body over all displacements, constrained ones zero: nine numbers per stencil slot.
struct Operator {
  Cells cells;
  std::vector<std::array<double, 9>> block;  // 27 per node
  std::vector<bool> moving;                  // three per node
};

std::vector<bool> moving_components(const Cells& cells, FarEnd end) {
  std::vector<bool> moving(3 * node_count(cells));
  for (std::uint32_t n = 0; n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) moving[3 * n + c] = moves(cells, end, n, c);
  }
  return moving;
}

Operator make_operator(const StiffnessTerms& terms, double across, double along, std::vector<bool> moving) {
  const Cells& cells = terms.cells;
  Operator op{cells, std::vector<std::array<double, 9>>(terms.pair.size()), std::move(moving)};
  const double scale = 1 / (across * across * along);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const std::size_t at = n * stencil_size + slot;
      const auto b = stiffness_block(terms.pair[at], across, along);
      const double s = scale / std::sqrt(terms.lumped_mass_kg[n] * terms.lumped_mass_kg[m]);
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
          if (op.moving[3 * n + r] && op.moving[3 * m + c]) op.block[at][3 * r + c] = s * b[3 * r + c];
        }
      }
    });
  });
  return op;
}

void multiply(const Operator& op, const std::vector<double>& x, std::vector<double>& y) {
  for_each_node(op.cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(op.cells, i, j, k);
    double f[3] = {0, 0, 0};
    for_each_neighbour(op.cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
      const auto& b = op.block[n * stencil_size + slot];
      for (std::size_t r = 0; r < 3; ++r) {
        f[r] += b[3 * r] * x[3 * m] + b[3 * r + 1] * x[3 * m + 1] + b[3 * r + 2] * x[3 * m + 2];
      }
    });
    for (std::size_t r = 0; r < 3; ++r) y[3 * n + r] = f[r];
  });
}

/// Gershgorin's bound on the largest eigenvalue.
double gershgorin(const Operator& op) {
  double largest = 0;
  for (std::size_t n = 0; n < node_count(op.cells); ++n) {
    for (std::size_t r = 0; r < 3; ++r) {
      double sum = 0;
      for (std::size_t s = 0; s < stencil_size; ++s) {
        for (std::size_t c = 0; c < 3; ++c) sum += std::abs(op.block[n * stencil_size + s][3 * r + c]);
      }
      largest = std::max(largest, sum);
    }
  }
  return largest;
}

/// Largest eigenvalue of a symmetric tridiagonal matrix by bisection on Sturm's count, to 1e-9 of `high`.
double tridiagonal_top(const std::vector<double>& diagonal, const std::vector<double>& off, double high) {
  double low = 0;
  const double width = 1e-9 * high;
  while (high - low > width) {
    const double x = 0.5 * (low + high);
    double d = 1;
    bool above = false;  // whether an eigenvalue exceeds x
    for (std::size_t i = 0; i < diagonal.size() && !above; ++i) {
      d = x - diagonal[i] - (i > 0 ? off[i - 1] * off[i - 1] / d : 0.0);
      above = !(d > 0);
    }
    (above ? low : high) = x;
  }
  return low;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Largest eigenvalue from below (Lanczos, no reorthogonalisation: copies of converged values do no harm here).
double lanczos_top(const Operator& op, double bound) {
  const std::size_t size = op.moving.size();
  std::vector<double> before(size), now(size), next(size), diagonal, off;
  std::uint32_t seed = 2463534242U;
  for (std::size_t i = 0; i < size; ++i) {
    seed ^= seed << 13U;
    seed ^= seed >> 17U;
    seed ^= seed << 5U;
    if (op.moving[i]) now[i] = static_cast<double>(seed) / 4294967296.0 - 0.5;
  }
  const double norm = std::sqrt(dot(now, now));
  for (double& x : now) x /= norm;
  double top = 0;
  const std::size_t longest = std::min<std::size_t>(size, 240);
  for (std::size_t step = 1; step <= longest; ++step) {
    multiply(op, now, next);
    const double a = dot(now, next);
    diagonal.push_back(a);
    for (std::size_t i = 0; i < size; ++i) next[i] -= a * now[i] + (off.empty() ? 0.0 : off.back()) * before[i];
    const double b = std::sqrt(dot(next, next));
    if (step % 12 == 0 || step == longest || b < 1e-12 * bound) {
      const double last = top;
      top = tridiagonal_top(diagonal, off, bound);
      if (top - last < 3e-6 * top || b < 1e-12 * bound) break;
    }
    off.push_back(b);
    before.swap(now);
    for (std::size_t i = 0; i < size; ++i) now[i] = next[i] / b;
  }
  return top;
}

/// Whether σ·I − K̃ has a Cholesky factor: then no eigenvalue reaches σ. Banded, column by column; only the last
/// `band` rows are kept.
bool exceeds_spectrum(const Operator& op, double sigma) {
  const Cells& cells = op.cells;
  const std::size_t size = op.moving.size();
  const std::size_t band = 3 * (plane_nodes(cells) + cells[0] + 2) + 2;
  std::vector<double> factor((band + 1) * (band + 1));  // row i at (i mod band+1), column c at c + band − i
  std::vector<double> row(band + 1);
  bool positive = true;
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const std::uint32_t n = node_index(cells, i, j, k);
    for (std::size_t r = 0; r < 3 && positive; ++r) {
      const std::size_t at = 3 * n + r;
      std::fill(row.begin(), row.end(), 0.0);  // row[c + band − at] of σ·I − K̃, up to the diagonal
      for_each_neighbour(cells, i, j, k, [&](std::uint32_t m, std::size_t slot) {
        for (std::size_t c = 0; c < 3; ++c) {
          if (3 * m + c <= at) row[3 * m + c + band - at] = -op.block[n * stencil_size + slot][3 * r + c];
        }
      });
      row[band] += sigma;
      for (std::size_t c = at > band ? at - band : 0; c <= at; ++c) {
        const double* other = c == at ? row.data() : &factor[(c % (band + 1)) * (band + 1)];
        double sum = row[c + band - at];
        const std::size_t first = at > band ? at - band : 0;
        for (std::size_t p = first; p < c; ++p) sum -= row[p + band - at] * other[p + band - c];
        if (c < at) {
          row[c + band - at] = sum / other[band];
        } else if (sum > 0) {
          row[band] = std::sqrt(sum);
        } else {
          positive = false;
        }
      }
      std::copy(row.begin(), row.end(), factor.begin() + static_cast<std::ptrdiff_t>((at % (band + 1)) * (band + 1)));
    }
  });
  return positive && size > 0;
}

/// An upper bound on the largest eigenvalue of M^{-½}KM^{-½}, within 0.1 % of it and proven; of a mesh too wide to
/// factorise in a few seconds, within 2 % and not proven.
double top_eigenvalue(const Operator& op) {
  const double cap = gershgorin(op);
  const double below = lanczos_top(op, cap);
  const double band = 3.0 * plane_nodes(op.cells);
  if (static_cast<double>(op.moving.size()) * band * band > 6e9) return std::min(cap, 1.02 * below);
  for (double margin = 2e-4; below * (1 + margin) < cap; margin *= 4) {
    if (exceeds_spectrum(op, below * (1 + margin))) return below * (1 + margin);
  }
  return cap;
}

double top_eigenvalue(const StiffnessTerms& terms, double across, double along, FarEnd end) {
  return top_eigenvalue(make_operator(terms, across, along, moving_components(terms.cells, end)));
}

}  // namespace

double critical_step(const StiffnessTerms& terms, double across, double along, FarEnd end) {
  return 2 / std::sqrt(top_eigenvalue(terms, across, along, end));
}

double element_critical_step(const HexahedralMesh& mesh, const Material& material, double across, double along) {
  double top = 0;
  constexpr std::array<std::size_t, 8> block_order = {0, 1, 3, 2, 4, 5, 7, 6};
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    const Hexahedron h = element_nodes(mesh.cells, e);
    HexahedralMesh one{{1, 1, 1}, {}};
    for (const std::size_t corner : block_order) one.node.push_back(mesh.node[h[corner]]);
    const auto terms = assemble(one, material);
    if (!terms) return 0;
    top = std::max(top, top_eigenvalue(make_operator(*terms, across, along, std::vector<bool>(24, true))));
  }
  return 2 / std::sqrt(top);
}

CriticalSteps tabulate_critical_steps(const StiffnessTerms& terms, FarEnd end, double lowest, double highest) {
  CriticalSteps table;
  const double intervals = highest > lowest ? std::ceil(std::log(highest / lowest) / std::log(1.06)) : 0;
  for (double i = 0; i <= intervals; ++i) {
    const double r = intervals > 0 ? lowest * std::pow(highest / lowest, i / intervals) : lowest;
    table.ratio.push_back(r);
    // at S = r, l = 1: K / (S²·l) = (A + r·B + r²·C) / r², so g = r²·ω²
    table.top.push_back(r * r * top_eigenvalue(terms, r, 1, end));
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
  double top = table.top.front();
  for (std::size_t i = 1; i < table.ratio.size() && r > table.ratio[i - 1]; ++i) {
    const double s = (r - table.ratio[i - 1]) / (table.ratio[i] - table.ratio[i - 1]);
    top = table.top[i - 1] + s * (table.top[i] - table.top[i - 1]);
  }
  // K / (S²·l·M₁) at (S, l): l·(A + r·B + r²·C) / (S²·l)
  return (1 - 4 * slack) * 2 * across / std::sqrt(top);
}

std::uint32_t substeps_within(double critical_step_s, double tick_s) {
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(tick_s / (0.9 * critical_step_s))));
}

}  // namespace mobil
