#include "assets/gait/run_lookup.h"

#include <algorithm>
#include <cmath>

namespace mobil::inline v0_3 {
namespace {

/// Four neighbours of a speed with their weights.
struct RunBlend {
  std::array<std::size_t, 4> node;
  std::array<double, 4> weight;
};

/// Returns weights of the cubic between two nodes whose slopes at a node are those of the parabola through it and its
/// neighbours, at the ends those of the line to the other node.
RunBlend run_blend(double at) {
  const auto& x = run_table::speed;
  const double speed = std::clamp(at, x.front(), x.back());
  std::size_t i = 0;
  while (i + 2 < run_table::speed_count && speed > x[i + 1]) ++i;
  const double span = x[i + 1] - x[i], u = (speed - x[i]) / span, v = 1 - u;
  RunBlend b{{i == 0 ? 0 : i - 1, i, i + 1, std::min(i + 2, run_table::speed_count - 1)},
             {0, (1 + 2 * u) * v * v, u * u * (3 - 2 * u), 0}};
  /// Adds `times` the slope at neighbour k, over the interval.
  const auto add_slope = [&](std::size_t k, double times) {
    const double before = x[b.node[k]] - x[b.node[k - 1]], after = x[b.node[k + 1]] - x[b.node[k]];
    const double left = before > 0 && after > 0 ? after / (before + after) : before > 0 ? 1 : 0;
    const double by_left = before > 0 ? times * span * left / before : 0,
                 by_right = after > 0 ? times * span * (1 - left) / after : 0;
    b.weight[k - 1] -= by_left;
    b.weight[k] += by_left - by_right;
    b.weight[k + 1] += by_right;
  };
  add_slope(1, u * v * v);
  add_slope(2, -u * u * v);
  return b;
}

template <std::size_t count>
void add_run(const std::array<double, count>& from, double weight, std::array<double, count>& to) {
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

RunGiven run_given_of(const RunBlend& b) {
  RunGiven sum{};
  for (std::size_t k = 0; k < b.node.size(); ++k) {
    const RunGiven& g = run_given[b.node[k]];
    const double w = b.weight[k];
    sum.frequency += w * g.frequency;
    sum.duty += w * g.duty;
    add_run(g.tilt, w, sum.tilt);
    add_run(g.turn, w, sum.turn);
    add_run(g.list, w, sum.list);
    add_run(g.shoulder, w, sum.shoulder);
    add_run(g.elbow, w, sum.elbow);
  }
  return sum;
}

/// Returns weights of the three step lengths.
std::array<double, run_table::length_count> run_length_weights(double length) {
  const auto& x = run_table::length;
  const double at = std::clamp(length, x.front(), x.back());
  std::array<double, run_table::length_count> weight{};
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = 1;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      if (k != i) weight[i] *= (at - x[k]) / (x[i] - x[k]);
    }
  }
  return weight;
}

}  // namespace

RunGiven usual_run(double speed) {
  return run_given_of(run_blend(speed));
}

double usual_run_length(double speed) {
  return speed / usual_run(speed).frequency;
}

TabledRun tabled_run(double speed, double length) {
  const RunBlend b = run_blend(speed);
  TabledRun run{run_given_of(b), {}};
  const auto& x = run_table::length;
  run.given.frequency /= std::clamp(length, x.front(), x.back());
  const auto by_length = run_length_weights(length);
  for (std::size_t k = 0; k < b.node.size(); ++k) {
    for (std::size_t l = 0; l < by_length.size(); ++l) {
      const auto w = static_cast<float>(b.weight[k] * by_length[l]);
      if (w == 0) continue;
      const RunNode& node = run_nodes[b.node[k]][l];
      for (std::size_t i = 0; i < run_shape::size; ++i) run.node.shape[i] += w * node.shape[i];
      for (std::size_t i = 0; i < node.centre_up.size(); ++i) {
        run.node.centre_ahead[i] += w * node.centre_ahead[i];
        run.node.centre_up[i] += w * node.centre_up[i];
      }
    }
  }
  return run;
}

}  // namespace mobil::inline v0_3
