#include "assets/fem/axial_stiffness.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/engine/interrupt.h>
#include "assets/fem/critical_step.h"
#include "assets/fem/stencil_matrix.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

using Displacements = std::vector<double>;

/// A belly of one body, and ω² of its sideways foundation.
class Sized {
 public:
  Sized(const StiffnessTerms& terms, double across, double along, double sideways_1_s2 = 0)
      : terms_(terms),
        stiffness_(terms.cells,
                   [&](std::uint32_t n, std::uint32_t, std::size_t slot) {
                     return stiffness_block(terms.pair[n * stencil_size + slot], across, along);
                   }),
        sideways_(sideways_1_s2 * across * across * along) {}

  const Cells& cells() const { return terms_.cells; }
  /// y = K·x over all displacements, including constrained ones.
  void multiply(const Displacements& x, Displacements& y) const {
    stiffness_.multiply(x, y);
    for (std::size_t n = 0; sideways_ > 0 && n < terms_.lumped_mass_kg.size(); ++n)
      for (std::size_t r = 0; r < 2; ++r) y[3 * n + r] += sideways_ * terms_.lumped_mass_kg[n] * x[3 * n + r];
  }

 private:
  const StiffnessTerms& terms_;
  StencilMatrix stiffness_;
  double sideways_;
};

double scalar_product(const Displacements& a, const Displacements& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Solves K·u = `load` where u is free to move, from a u that has the prescribed ends.
void solve(const Sized& belly, FarEnd end, const Displacements& load, Displacements& u) {
  const Cells& cells = belly.cells();
  const auto hold = [&](Displacements& v) {  // zero where the displacement is prescribed
    for (std::uint32_t n = 0; n < node_count(cells); ++n) {
      for (std::size_t c = 0; c < 3; ++c) {
        if (!moves(cells, end, n, c)) v[3 * n + c] = 0;
      }
    }
  };
  const std::size_t size = u.size();
  Displacements r(size), q(size);
  belly.multiply(u, r);
  for (std::size_t i = 0; i < size; ++i) r[i] = load[i] - r[i];
  hold(r);
  Displacements p = r;
  double rr = scalar_product(r, r);
  const double enough = 1e-20 * rr;
  for (std::size_t step = 0; step < 4 * size && rr > enough; ++step) {
    check_interrupt();
    belly.multiply(p, q);
    hold(q);
    const double alpha = rr / scalar_product(p, q);
    for (std::size_t i = 0; i < size; ++i) {
      u[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    const double next = scalar_product(r, r);
    for (std::size_t i = 0; i < size; ++i) p[i] = r[i] + next / rr * p[i];
    rr = next;
  }
}

}  // namespace

StaticStretch static_stretch(const StiffnessTerms& terms, double across, double along, double foundation_hz) {
  const Cells& cells = terms.cells;
  const double circular = 2 * std::numbers::pi * foundation_hz;
  const Sized belly(terms, across, along, circular * circular);
  const std::size_t size = 3 * std::size_t{node_count(cells)};
  // The uniform stretch already has the prescribed ends.
  Displacements u(size, 0.0), force(size);
  for_each_node(cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    u[3 * node_index(cells, i, j, k) + 2] = static_cast<double>(k) / cells[2];
  });
  solve(belly, FarEnd::held, Displacements(size, 0.0), u);
  belly.multiply(u, force);
  StaticStretch stretch{std::move(u), 0};
  for (std::uint32_t n = first_insertion_node(cells); n < node_count(cells); ++n) {
    stretch.stiffness_n_per_m += force[3 * n + 2];
  }
  return stretch;
}

double pulled_stiffness(const StiffnessTerms& terms, std::span<const float> far_share, double across, double along) {
  const std::size_t size = 3 * std::size_t{node_count(terms.cells)};
  const std::size_t far = first_insertion_node(terms.cells);
  Displacements u(size, 0.0), load(size, 0.0);
  for (std::size_t i = 0; i < far_share.size(); ++i) load[3 * (far + i) + 2] = static_cast<double>(far_share[i]);
  solve(Sized(terms, across, along), FarEnd::sliding, load, u);
  return 1 / scalar_product(load, u);
}

AxialStiffness tabulate_axial_stiffness(const StiffnessTerms& terms, std::span<const float> far_share, double lowest,
                                        double highest) {
  const auto steps =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(exact::log(highest / lowest) / exact::log(1.2))));
  AxialStiffness table;
  for (std::size_t i = 0; i <= steps; ++i) {
    const double r = lowest * exact::pow(highest / lowest, static_cast<double>(i) / static_cast<double>(steps));
    table.ratio.push_back(r);
    table.per_ratio.push_back(pulled_stiffness(terms, far_share, r, 1.0) / (r * r));
  }
  return table;
}

double axial_stiffness(const AxialStiffness& table, double across, double along) {
  const double r = across / along;
  const auto above = std::upper_bound(table.ratio.begin(), table.ratio.end(), r);
  double per_ratio = 0;
  if (above == table.ratio.begin()) {
    per_ratio = table.per_ratio.front();
  } else if (above == table.ratio.end()) {
    per_ratio = table.per_ratio.back();
  } else {
    const auto i = static_cast<std::size_t>(above - table.ratio.begin());
    const double t = (r - table.ratio[i - 1]) / (table.ratio[i] - table.ratio[i - 1]);
    per_ratio = table.per_ratio[i - 1] + t * (table.per_ratio[i] - table.per_ratio[i - 1]);
  }
  return across * r * per_ratio;
}

}  // namespace mobil::inline v0_3
