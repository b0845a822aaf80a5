// Figures 18, 19 and 20 of the paper as numbers: what one second of one muscle costs by method, step and mesh, how far
// the cheap solution is from the dear one, and whether a fourth muscle group at 3 ms costs what three cost at 2 ms.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/engine/jobs.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"

namespace mobil {
namespace {

struct FigureMesh {
  std::string_view nodes;
  Cells cells;
};
constexpr FigureMesh coarse{"81", {2, 2, 8}}, fine{"525", {4, 4, 20}}, finest{"3321", {8, 8, 40}};
constexpr std::array steps_ms = {0.5, 1.0, 2.0, 3.0, 4.0};
constexpr double lanes = lane_count;

/// What a second of the whole block of sixteen takes, s; none where the step is refused.
struct Cost {
  std::optional<Measured> block;
  double limit_s = 0;  // infinite for CAA
};

Mass mass_of(Method method) {
  return method == Method::icd ? Mass::consistent : Mass::lumped;
}

Cost second(const BenchRun& run, const MuscleTemplate& muscle, Method method, double dt_s) {
  Cost cost{std::nullopt, INFINITY};
  if (method != Method::caa) cost.limit_s = paper_limit_s(muscle, mass_of(method));
  if (dt_s > cost.limit_s) return cost;
  std::optional<BellySolver> solver;
  if (method != Method::ecd) solver = must(make_belly_solver(muscle, method, mass_of(method), dt_s));
  BenchBellies bellies(muscle, Stiffness::shared, 1);
  const auto a_tick = static_cast<std::uint32_t>(std::max(1L, std::lround(1.0 / 60 / dt_s)));
  const double ticks = 1 / (dt_s * a_tick);  // a second
  const auto work = [&] { bellies.tick(a_tick, static_cast<float>(dt_s * a_tick), solver ? &*solver : nullptr); };
  const double once_s = measure(2, work).best_s;
  const int runs = run.quick ? 1 : runs_a_repeat(once_s);
  const int repeats = run.rounds(std::clamp(static_cast<int>(0.15 / (runs * once_s)), 3, bench_repeats));
  const Measured time = measure(repeats, [&] {
    for (int i = 0; i < runs; ++i) work();
  });
  if (!bellies.finite()) throw Stopped("a displacement is not a number");
  const double scale = ticks / runs;
  cost.block = Measured{time.best_s * scale, time.median_s * scale, *time.cpu_s * scale};
  return cost;
}

/// Says so where the step is above the method's limit.
void add_cost(BenchRun& run, const std::string& name, const Cost& cost) {
  if (!cost.block) {
    run.notes.push_back(fmt::format("{}: above the limit {:.2f} ms", name, cost.limit_s * 1e3));
    return;
  }
  run.add_time(name + ".us_per_simulated_s", *cost.block, lanes, 1e-6, "us").bound =
      fmt::format("a simulated second of one of sixteen; the block {:.0f} us, {:.0f} times real time",
                  cost.block->best_s * 1e6, 1 / cost.block->best_s);
}

/// Figure 18, one mesh; and of 81 nodes, figure 20 right is its first row.
std::map<double, Cost> figure18(BenchRun& run, const FigureMesh& mesh, const MuscleTemplate& muscle) {
  std::map<double, Cost> explicit_costs;
  for (const Method method : {Method::ecd, Method::icd, Method::caa}) {
    const std::string_view name = method_name[static_cast<std::size_t>(method)];
    for (const double ms : steps_ms) {
      const auto cost = second(run, muscle, method, ms * 1e-3);
      add_cost(run, fmt::format("figure18.{}{}.{:.1f}ms", name, mesh.nodes, ms), cost);
      if (method == Method::ecd) explicit_costs[ms] = cost;
    }
  }
  return explicit_costs;
}

/// Figure 20 left: ECD at 1 ms on three meshes; a mesh that 1 ms is too long for at 0.9 of its limit.
void figure20_left(BenchRun& run) {
  for (const FigureMesh& mesh : {coarse, fine, finest}) {
    const auto muscle = paper_block(mesh.cells);
    const auto cost = second(run, muscle, Method::ecd, 1e-3);
    add_cost(run, fmt::format("figure20.ecd{}.1.0ms", mesh.nodes), cost);
    if (cost.block) continue;
    const double dt_s = 0.9 * cost.limit_s;
    const auto shorter = second(run, muscle, Method::ecd, dt_s);
    add_cost(run, fmt::format("figure20.ecd{}.{:.2f}ms", mesh.nodes, dt_s * 1e3), shorter);
  }
}

/// One second of elongation of the template's body, one sample a step.
std::vector<double> history(const MuscleTemplate& muscle, Method method, double dt_s) {
  std::optional<BellySolver> solver;
  if (method != Method::ecd) solver = must(make_belly_solver(muscle, method, mass_of(method), dt_s));
  return bench_histories(muscle, Stiffness::shared, dt_s, 1, solver ? &*solver : nullptr)[0];
}

/// Figure 19 as numbers, and the errors that the claim of a fourth group rests on.
void figure19(BenchRun& run) {
  const auto few = paper_block(coarse.cells), many = paper_block(fine.cells), most = paper_block({8, 8, 32});
  const auto caa = history(many, Method::caa, 1e-3), ecd2 = history(few, Method::ecd, 2e-3),
             ecd3 = history(few, Method::ecd, 3e-3), converged2 = history(most, Method::ecd, 5e-4),
             converged3 = history(most, Method::ecd, 7.5e-4), precise = history(few, Method::ecd, 1e-4);
  const auto add = [&](const char* name, const std::vector<double>& a, const std::vector<double>& b,
                       const std::string& what) {
    run.add_figure(name, history_error(a, b), "1", what + ", a second of elongation, rms over peak");
  };
  add("figure19.ecd81_to_caa525", ecd2, caa, "ECD 81 at 2 ms from CAA 525 at 1 ms");
  add("figure19.caa525_to_converged", caa, converged2, "CAA 525 at 1 ms from 2673 nodes at 0.5 ms");
  add("figure19.ecd81_2ms_to_converged", ecd2, converged2, "ECD 81 at 2 ms from 2673 nodes at 0.5 ms");
  add("figure19.ecd81_3ms_to_converged", ecd3, converged3, "ECD 81 at 3 ms from 2673 nodes at 0.75 ms");
  add("figure19.ecd81_2ms_to_own", ecd2, precise, "ECD 81 at 2 ms from itself at 0.1 ms");
  add("figure19.ecd81_3ms_to_own", ecd3, precise, "ECD 81 at 3 ms from itself at 0.1 ms");
}

/// "Also a four muscular group could be calculated with enough accuracy if Δt is increased to 0.003."
void four_groups(BenchRun& run, const std::map<double, Cost>& costs) {
  const double at2 = *costs.at(2.0).block->cpu_s / lanes, at3 = *costs.at(3.0).block->cpu_s / lanes;
  run.add_figure(
      "figure20.four_groups_at_3ms_over_three_at_2ms", 4 * at3 / (3 * at2), "1",
      fmt::format("of one leg; the paper's claim holds up to 1; {:.0f} times faster than real time", 1 / (4 * at3)));
}

}  // namespace

void bench_paper_figures(BenchRun& run) {
  const FlushDenormals flushed;
  std::map<double, Cost> explicit_costs;
  for (const FigureMesh& mesh : {fine, coarse}) {
    const auto muscle = paper_block(mesh.cells);
    explicit_costs = figure18(run, mesh, muscle);
  }
  figure19(run);
  figure20_left(run);
  four_groups(run, explicit_costs);
}

}  // namespace mobil
