#include "demo/lab/run_fit/run_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "demo/lab/compare/compare_reference.h"

namespace mobil {
namespace {

using namespace run_table;

constexpr std::size_t first_speed = 3;  // 2.5 m/s, from which all others are reached
constexpr double evenness_of_runs = 0.12, balance_when_even = 120;
constexpr int evening_passes = 6;
/// Gains below which a fit ends, as LeastSquares::min_gain: of one that others start from, and of others.
constexpr double fine = 1e-6, coarse = 1e-5;

/// Fits the first `count` numbers of a shape.
double solve_run(const RunFitNode& node, const RunWeights& weights, const RunShape& likely, const LeastSquares& options,
                 std::size_t count, RunShape& shape) {
  static constexpr RunShape scales = run_shape_scales();
  RunShape aimed = likely;  // also has the numbers that are not fitted
  std::copy(shape.begin() + static_cast<long>(count), shape.end(), aimed.begin() + static_cast<long>(count));
  return least_squares(run_residuals(node.task, node.targets, weights, aimed), std::span(scales).first(count), options,
                       std::span(shape).first(count));
}

double least_slack(const RunTask& task, const RunShape& shape) {
  RunModel model(task);
  RunCycle cycle;
  model.evaluate(shape, cycle);
  return std::ranges::min(cycle.cycle.slack);
}

/// Lowers the centre of mass until both legs have that much slack.
void lower_until(double slack_m, const RunTask& task, RunShape& shape) {
  constexpr double lowered_m = 0.004;
  constexpr int most = 40;
  for (int times = 0; times < most && least_slack(task, shape) < slack_m; ++times)
    shape[run_shape::centre.first + 1] -= lowered_m;
}

/// Returns the mean of two lines at a node: through its neighbours in speed, continued at the ends of the table, and
/// the nearest one to the three step lengths.
RunShape between_neighbours(const std::vector<RunFitNode>& nodes, std::size_t i) {
  const std::size_t s = i / length_count, l = i % length_count;
  const bool at_end = s == 0 || s + 1 == speed_count;
  const std::size_t low = s == 0 ? 1 : s - (at_end ? 2 : 1), high = low + (at_end ? 1 : 2);
  const double part = (speed[s] - speed[low]) / (speed[high] - speed[low]);
  const auto at = [&](std::size_t speed_number, std::size_t length_number) -> const RunShape& {
    return nodes[speed_number * length_count + length_number].shape;
  };
  RunShape shape;
  for (std::size_t k = 0; k < shape.size(); ++k) {
    const double by_speed = std::lerp(at(low, l)[k], at(high, l)[k], part);
    const double bend = at(s, 0)[k] - 2 * at(s, usual)[k] + at(s, 2)[k];
    const double by_length = at(s, l)[k] + (l == usual ? bend / 3 : -bend / 6);
    shape[k] = 0.5 * (by_speed + by_length);
  }
  return shape;
}

double mean_cost(const std::vector<RunFitNode>& nodes) {
  double sum = 0;
  for (const RunFitNode& node : nodes) sum += node.cost / static_cast<double>(nodes.size());
  return sum;
}

}  // namespace

RunFitNode run_node(std::size_t speed_number, std::size_t length_number) {
  const double leg = fraction::hip_height * fitted_height_m;
  const double times = length[length_number];
  RunFitNode node{{}, run_targets(speed[speed_number] * std::sqrt(gravity_m_s2 * leg), leg, times), {}};
  node.task = run_task(node.targets);
  node.shape = first_run_shape(node.task, node.targets);
  return node;
}

RunTask tabled_run_task(double at, const TabledRun& run, std::size_t samples) {
  const double leg = fraction::hip_height * fitted_height_m;
  RunTargets given{};
  given.speed_m_s = at * std::sqrt(gravity_m_s2 * leg);
  given.frequency_hz = run.given.frequency * std::sqrt(gravity_m_s2 / leg);
  given.duty = run.given.duty;
  given.given = run.given;
  return run_task(given, samples);
}

void fit_run_alone(RunFitNode& node) {
  const RunShape start = node.shape;
  solve_run(node, {.forces = 0.6, .moments = 0.03, .balance = 1, .aside = 0}, start, {60, coarse}, run_sagittal,
            node.shape);
  solve_run(node, {.moments = 0.3, .balance = 8, .aside = 0}, start, {60, coarse}, run_sagittal, node.shape);
  solve_run(node, {.aside = 0}, start, {150, coarse}, run_sagittal, node.shape);
  node.cost = solve_run(node, {}, start, {400, fine}, run_shape::size, node.shape);
}

void fit_run_from(const RunShape& neighbour, RunFitNode& node) {
  constexpr double spare_m = 0.004;
  RunShape& shape = node.shape = neighbour;
  lower_until(spare_m, node.task, shape);
  const RunShape start = shape;
  constexpr std::size_t ahead = run_sagittal;
  solve_run(node, {.forces = 0.6, .moments = 0, .balance = 0, .aside = 0, .reach = 5000, .min_slack_m = spare_m}, start,
            {20, coarse}, ahead, shape);
  solve_run(node, {.forces = 0.6, .moments = 0.03, .balance = 1, .aside = 0, .reach = 5000, .min_slack_m = 0.003},
            start, {25, coarse}, ahead, shape);
  solve_run(node, {.moments = 0.4, .balance = 8, .aside = 0}, start, {30, coarse}, ahead, shape);
  node.cost = solve_run(node, {}, neighbour, {150, fine}, run_shape::size, shape);
}

void even_runs(const Jobs& jobs, const RunProgress& progress, std::vector<RunFitNode>& nodes) {
  for (int pass = 0; pass < evening_passes; ++pass) {
    const std::vector<RunFitNode> before = nodes;
    in_parallel(jobs, nodes.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        nodes[i].cost = solve_run(nodes[i], {.balance = balance_when_even, .likely = evenness_of_runs},
                                  between_neighbours(before, i), {25, coarse}, run_shape::size, nodes[i].shape);
    });
    progress(fmt::format("even, pass {}", pass + 1), mean_cost(nodes));
  }
}

void fit_run_length(const RunShape& usual_one, RunFitNode& node) {
  constexpr int parts = 4;
  RunFitNode between = node;
  between.shape = usual_one;
  const double times = node.targets.times;
  for (int k = 1; k <= parts; ++k) {
    const double part = static_cast<double>(k) / parts;
    if (k < parts) {
      between.targets = run_targets(node.task.speed_m_s, node.task.body.size.leg, std::lerp(1, times, part));
      between.task = run_task(between.targets);
    } else {
      between.targets = node.targets;
      between.task = node.task;
    }
    const RunShape before = between.shape;
    lower_until(0.003, between.task, between.shape);
    between.cost =
        solve_run(between, {.likely = 0.05}, before, {k < parts ? 20 : 60, coarse}, run_shape::size, between.shape);
  }
  node.shape = between.shape;
  node.cost = between.cost;
}

std::vector<RunFitNode> fit_runs(const Jobs& jobs, const RunProgress& progress) {
  std::vector<RunFitNode> nodes;
  for (std::size_t s = 0; s < speed_count; ++s) {
    for (std::size_t l = 0; l < length_count; ++l) nodes.push_back(run_node(s, l));
  }
  const auto usual_at = [&](std::size_t s) -> RunFitNode& { return nodes[s * length_count + usual]; };
  const auto told = [&](const RunFitNode& node) {
    const auto i = static_cast<std::size_t>(&node - nodes.data());
    progress(fmt::format("{:.2f} m/s, length {:.2f}", node.task.speed_m_s, length[i % length_count]), node.cost);
  };
  fit_run_alone(usual_at(first_speed));
  told(usual_at(first_speed));
  for (std::size_t s = first_speed + 1; s < speed_count; ++s) {
    fit_run_from(usual_at(s - 1).shape, usual_at(s));
    told(usual_at(s));
  }
  for (std::size_t s = first_speed; s-- > 0;) {
    fit_run_from(usual_at(s + 1).shape, usual_at(s));
    told(usual_at(s));
  }
  // The end of a fit depends on its start. Each usual step starts once from both neighbours, and the best is kept.
  const std::vector<RunFitNode> before = nodes;
  in_parallel(jobs, speed_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      for (const std::size_t other : {s - 1, s + 1}) {
        if (other >= speed_count) continue;
        RunFitNode again = usual_at(s);
        fit_run_from(before[other * length_count + usual].shape, again);
        if (again.cost < usual_at(s).cost) usual_at(s) = again;
      }
      told(usual_at(s));
    }
  });
  in_parallel(jobs, nodes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (i % length_count == usual) continue;
      fit_run_length(usual_at(i / length_count).shape, nodes[i]);
      told(nodes[i]);
    }
  });
  even_runs(jobs, progress, nodes);
  return nodes;
}

std::array<float, run_shape::size> tabled(const RunShape& shape) {
  return tabled(shape, run_shape::parts);
}

RunShape fitted(const std::array<float, run_shape::size>& shape) {
  return fitted(shape, run_shape::parts);
}

RunNode table_node(const RunFitNode& node) {
  RunNode out{tabled(node.shape), {}, {}};
  RunModel model(node.task);
  RunCycle cycle;
  model.evaluate(node.shape, cycle);
  const std::size_t half = cycle.step.centre.size();
  for (std::size_t k = 0; k <= 2; ++k) {
    double ahead[2] = {}, up[2] = {};
    for (std::size_t i = 0; i < half; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k * i) / static_cast<double>(half);
      const double wave[2] = {std::cos(angle), std::sin(angle)};
      for (std::size_t w = 0; w < 2; ++w) {
        const double each = wave[w] * (k == 0 ? 1 : 2) / static_cast<double>(half) / fitted_height_m;
        ahead[w] += each * (cycle.step.centre[i].z - cycle.cycle.hips[i].z);
        up[w] += each * (cycle.step.centre[i].y - cycle.cycle.hips[i].y);
      }
    }
    out.centre_ahead[k] = static_cast<float>(ahead[0]);
    out.centre_up[k] = static_cast<float>(up[0]);
    if (k == 0) continue;
    out.centre_ahead[k + 2] = static_cast<float>(ahead[1]);
    out.centre_up[k + 2] = static_cast<float>(up[1]);
  }
  return out;
}

}  // namespace mobil
