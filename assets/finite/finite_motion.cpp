#include "assets/finite/finite_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "assets/finite/finite_sections.h"

namespace mobil::inline v0_3 {
namespace {

using Eigen::VectorXd;

constexpr double hht = -0.1, newmark_beta = (1 - hht) * (1 - hht) / 4, newmark_gamma = 0.5 - hht;
constexpr int max_iterations_a_step = 14;
constexpr double settled_m = 1e-7, longest_m = 0.01;

/// Returns the elements' and foundation's forces on the nodes between the faces, with their tangent in scratch.chain.
VectorXd holding_force(const FiniteBelly& belly, const Activity& activity, double foundation_hz,
                       const std::vector<double>& displacement_m, FiniteScratch& scratch) {
  assemble_elements(belly, activity, displacement_m, 0, 0, scratch);
  VectorXd force = -scratch.residual_n;
  const std::size_t plane = plane_nodes(belly.mesh.cells);
  const double circular = 2 * std::numbers::pi * foundation_hz;
  for (std::size_t n = plane; n < first_insertion_node(belly.mesh.cells); ++n) {
    const double stiffness = circular * circular * belly.node_mass_kg[n];
    for (std::size_t d = 0; d < 2; ++d) {
      const auto own = static_cast<Eigen::Index>(3 * (n % plane) + d);
      force[static_cast<Eigen::Index>(3 * (n - plane) + d)] += stiffness * displacement_m[3 * n + d];
      scratch.chain.own[n / plane - 1](own, own) += stiffness;
    }
  }
  return force;
}

double pushed_m_s2(const FinitePush& push, const Vec3<double>& at, std::size_t d) {
  const auto& row = push.gradient_s2[d];
  return push.constant_m_s2[d] + row[0] * at.x + row[1] * at.y + row[2] * at.z;
}

}  // namespace

FiniteMotion motion_at_rest(const FiniteBelly& belly) {
  const std::vector<double> none(3 * belly.mesh.node.size());
  return {none, none, none, 0, 0, {}};
}

Result<void> advance(const FiniteBelly& belly, FiniteScratch& scratch, const FiniteStep& step, FiniteMotion& motion) {
  const std::size_t first = 3 * std::size_t{plane_nodes(belly.mesh.cells)};
  const std::size_t last = 3 * std::size_t{first_insertion_node(belly.mesh.cells)};
  const auto rows = static_cast<Eigen::Index>(last - first);
  const double h = step.time_s;
  FiniteMotion next = motion;
  const VectorXd before = holding_force(belly, activity_of(belly, motion.shortening, motion.activation),
                                        step.foundation_hz, motion.displacement_m, scratch);
  const Activity activity = activity_of(belly, step.shortening, step.activation);
  for (std::size_t i = last; i < next.displacement_m.size(); i += 3)
    next.displacement_m[i + 2] = end_of(belly, step.shortening);
  const auto predicted = [&](std::size_t i) {
    return motion.displacement_m[i] + h * motion.velocity_m_s[i] +
           h * h * (0.5 - newmark_beta) * motion.acceleration_m_s2[i];
  };
  const auto follow = [&](std::size_t i) {
    next.acceleration_m_s2[i] = (next.displacement_m[i] - predicted(i)) / (newmark_beta * h * h);
    next.velocity_m_s[i] = motion.velocity_m_s[i] + h * ((1 - newmark_gamma) * motion.acceleration_m_s2[i] +
                                                         newmark_gamma * next.acceleration_m_s2[i]);
  };
  const double inertia =
      1 / (newmark_beta * h * h) / (1 + hht) + step.damping_per_s * newmark_gamma / (newmark_beta * h);
  for (int iteration = 0; iteration < max_iterations_a_step; ++iteration) {
    const VectorXd now = holding_force(belly, activity, step.foundation_hz, next.displacement_m, scratch);
    VectorXd change(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const auto i = first + static_cast<std::size_t>(row);
      const double mass = belly.node_mass_kg[i / 3];
      const Vec3<double>& at = belly.mesh.node[i / 3];
      follow(i);
      const double now_n =
          mass * (pushed_m_s2(step.push, at, i % 3) - step.damping_per_s * next.velocity_m_s[i]) - now[row];
      const double before_n =
          mass * (pushed_m_s2(motion.push, at, i % 3) - step.damping_per_s * motion.velocity_m_s[i]) - before[row];
      change[row] = now_n - (hht * before_n + mass * next.acceleration_m_s2[i]) / (1 + hht);
      const auto own = static_cast<Eigen::Index>((i - first) % first);
      scratch.chain.own[(i - first) / first](own, own) += inertia * mass;
    }
    if (!factorise(scratch.chain)) break;
    solve(scratch.chain, change);
    const double longest = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(longest)) break;
    const double share = std::min(1.0, longest_m / longest);
    for (std::size_t i = first; i < last; ++i)
      next.displacement_m[i] += share * change[static_cast<Eigen::Index>(i - first)];
    if (longest > settled_m) continue;
    for (std::size_t i = first; i < last; ++i) follow(i);
    next.shortening = step.shortening;
    next.activation = step.activation;
    next.push = step.push;
    motion = std::move(next);
    return {};
  }
  return fail(
      fmt::format("no motion found over a step of {:.3g} s at shortening {:.4g} and activation {:.4g}; take a"
                  " shorter one",
                  h, step.shortening, step.activation));
}

}  // namespace mobil::inline v0_3
