#include "assets/finite/finite_belly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "assets/finite/finite_sections.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t max_iterations = 16;
constexpr double converged_share = 1e-5;  // of the length, in a Newton step; the next one would be its square
constexpr double longest_share = 0.05;
constexpr double min_load = 1.0 / 64;

double foundation_per_kg(const FiniteBelly& belly) {
  const double circular = 2 * std::numbers::pi * belly.foundation_hz;
  return circular * circular;
}

/// Assembles the unbalanced forces (in scratch.residual_n, negated), and the tangent of elements and foundation.
void assemble_sections(const FiniteBelly& belly, const FiniteState& state, double stiffening, double pull_m,
                       FiniteScratch& scratch) {
  const std::size_t plane = plane_nodes(belly.mesh.cells), layers = belly.mesh.cells[2];
  const std::size_t rows = 3 * plane;
  assemble_elements(belly, activity_of(belly, state.shortening, state.activation), state.displacement_m, stiffening,
                    pull_m, scratch);
  const double per_kg = foundation_per_kg(belly);
  if (per_kg == 0) return;
  const auto means = section_means(belly, state);
  for (std::size_t s = 1; s < layers; ++s) {
    auto& own = scratch.chain.own[s - 1];
    const double* const mass = belly.node_mass_kg.data() + s * plane;
    for (std::size_t i = 0; i < plane; ++i) {
      for (std::size_t d = 0; d < 2; ++d) {
        const auto at = static_cast<Index>(3 * i + d);
        scratch.residual_n[static_cast<Index>((s - 1) * rows) + at] -= per_kg * mass[i] * means[s][d];
        for (std::size_t j = 0; j < plane; ++j) {
          own(static_cast<Index>(3 * j + d), at) += per_kg * mass[i] * mass[j] / belly.section_mass_kg[s];
        }
      }
    }
  }
}

/// Factorises the tangent of a state, stiffened until it is positive definite. Returns true if it already was.
bool factorise_tangent(const FiniteBelly& belly, const FiniteState& state, double pull_m, FiniteScratch& scratch) {
  double stiffening = 0;
  for (;;) {
    assemble_sections(belly, state, stiffening, pull_m, scratch);
    if (!std::isfinite(scratch.residual_n.squaredNorm())) return false;
    scratch.step_m = scratch.residual_n;
    if (factorise(scratch.chain)) break;
    ++scratch.stiffened;
    stiffening = std::max(0.01, 8 * stiffening);
    if (stiffening > 1e4) return false;
  }
  solve(scratch.chain, scratch.step_m);
  return stiffening == 0;
}

/// Moves the free nodes by `share` of the step, and the insertion face to the state's shortening.
void move_nodes(const FiniteBelly& belly, const FiniteScratch& scratch, double share, const std::vector<double>& from_m,
                FiniteState& state) {
  const std::size_t first = 3 * std::size_t{plane_nodes(belly.mesh.cells)};
  const std::size_t last = 3 * std::size_t{first_insertion_node(belly.mesh.cells)};
  for (std::size_t i = first; i < last; ++i) {
    state.displacement_m[i] = from_m[i] + share * scratch.step_m[static_cast<Index>(i - first)];
  }
  for (std::size_t i = last; i < from_m.size(); i += 3) {
    state.displacement_m[i + 2] = end_of(belly, state.shortening);
  }
}

/// Runs Newton's method at a load; returns true if it converged. `state` has that load and the shape of another.
bool converge(const FiniteBelly& belly, FiniteScratch& scratch, FiniteState& state) {
  const std::size_t last = 3 * std::size_t{first_insertion_node(belly.mesh.cells)};
  double pull_m = end_of(belly, state.shortening) - state.displacement_m[last + 2];
  std::vector<double> from = state.displacement_m;
  double before = 0, share = 1;
  for (std::size_t i = 0; i < max_iterations; ++i) {
    const bool first = i == 0;
    ++scratch.iterations;
    const VectorXd step = scratch.step_m;
    const bool definite = factorise_tangent(belly, state, first ? pull_m : 0, scratch);
    const double now = scratch.residual_n.norm();
    if (!std::isfinite(now)) return false;
    if (i > 1 && now > 2 * before && share > 0.1) {
      share *= 0.4;
      scratch.step_m = step;
      move_nodes(belly, scratch, share, from, state);
      continue;
    }
    before = now;
    from = state.displacement_m;
    const double longest = scratch.step_m.cwiseAbs().maxCoeff();
    if (!std::isfinite(longest)) return false;
    share = first ? 1 : std::min(1.0, longest_share * belly.length_m / longest);
    move_nodes(belly, scratch, share, from, state);
    if (definite && share == 1 && !(first && pull_m != 0) && longest < converged_share * belly.length_m) return true;
  }
  return false;
}

}  // namespace

Result<FiniteBelly> make_finite_belly(HexahedralMesh mesh, const FiniteTissue& tissue, double foundation_hz) {
  if (mesh.cells[2] < 2) return fail("a belly of one layer of cells has no node to move; take 2 or more along");
  if (!(foundation_hz >= 0 && foundation_hz <= 1000)) {
    return fail(fmt::format("foundation {} Hz must lie between 0 and 1000", foundation_hz));
  }
  auto elements = finite_elements(mesh, tissue);
  if (!elements) return tl::unexpected(elements.error());
  FiniteBelly belly;
  belly.tissue = tissue;
  belly.length_m = mesh.node.back().z - mesh.node.front().z;
  belly.foundation_hz = foundation_hz;
  belly.elements = std::move(*elements);
  belly.node_mass_kg.resize(mesh.node.size());
  const std::size_t plane = plane_nodes(mesh.cells);
  belly.section_mass_kg.resize(mesh.cells[2] + 1);
  for (const FiniteElement& element : belly.elements) {
    for (std::size_t a = 0; a < 8; ++a) {
      double mass = 0;
      for (const double m : element.mass_kg[a]) mass += m;
      belly.node_mass_kg[element.node[a]] += mass;
      belly.section_mass_kg[element.node[a] / plane] += mass;
    }
  }
  belly.mesh = std::move(mesh);
  return belly;
}

FiniteState state_at_rest(const FiniteBelly& belly) {
  return {0, 0, std::vector<double>(3 * belly.mesh.node.size())};
}

FiniteScratch make_scratch(const FiniteBelly& belly) {
  const std::size_t rows = 3 * std::size_t{plane_nodes(belly.mesh.cells)}, sections = belly.mesh.cells[2] - 1;
  FiniteScratch scratch;
  scratch.chain = make_chain(sections, rows);
  scratch.residual_n = VectorXd::Zero(static_cast<Index>(sections * rows));
  scratch.step_m = scratch.residual_n;
  return scratch;
}

Result<void> settle(const FiniteBelly& belly, FiniteScratch& scratch, FiniteState& state, double shortening,
                    double activation) {
  if (!(shortening >= -0.5 && shortening <= 0.5 && activation >= 0 && activation <= 1)) {
    return fail(fmt::format("shortening {} must lie between -0.5 and 0.5, activation {} between 0 and 1", shortening,
                            activation));
  }
  const FiniteState from = state;
  double done = 0, load = 1;
  while (done < 1) {
    FiniteState next = state;
    const double to = std::min(1.0, done + load);
    next.shortening = from.shortening + to * (shortening - from.shortening);
    next.activation = from.activation + to * (activation - from.activation);
    if (converge(belly, scratch, next)) {
      state = std::move(next);
      done = to;
      continue;
    }
    ++scratch.halvings;
    load *= 0.5;
    if (load < min_load) {
      return fail(
          fmt::format("no static shape found at shortening {:.4g} and activation {:.4g}; go there in smaller "
                      "steps, or from another side",
                      next.shortening, next.activation));
    }
  }
  state.shortening = shortening;
  state.activation = activation;
  return {};
}

std::vector<std::array<double, 2>> section_means(const FiniteBelly& belly, const FiniteState& state) {
  const std::size_t plane = plane_nodes(belly.mesh.cells);
  std::vector<std::array<double, 2>> means(belly.section_mass_kg.size());
  for (std::size_t n = 0; n < belly.node_mass_kg.size(); ++n) {
    const double share = belly.node_mass_kg[n] / belly.section_mass_kg[n / plane];
    for (std::size_t d = 0; d < 2; ++d) means[n / plane][d] += share * state.displacement_m[3 * n + d];
  }
  return means;
}

double volume_ratio(const FiniteBelly& belly, const FiniteState& state) {
  double now = 0, rest = 0;
  Corners gradient;
  for (const FiniteElement& element : belly.elements) {
    now += hexahedron_volume(corners_of(belly, element, state.displacement_m), gradient);
    rest += element.volume_m3;
  }
  return now / rest;
}

double worst_dilatation(const FiniteBelly& belly, const FiniteState& state) {
  double worst = 0;
  Corners gradient;
  for (const FiniteElement& element : belly.elements) {
    const double volume = hexahedron_volume(corners_of(belly, element, state.displacement_m), gradient);
    worst = std::max(worst, std::abs(volume / element.volume_m3 - 1));
  }
  return worst;
}

}  // namespace mobil::inline v0_3
