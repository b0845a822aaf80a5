// Figures 18, 19 and 20 of the paper as numbers: the cost of one second of one muscle by method, step and mesh; the
// error of the cheap solution; four muscle groups at 3 ms compared with three at 2 ms. Solving methods are Newmark
// average acceleration (CAA), implicit central differences (ICD) and static. Also cost and error of a step with one
// body for all people and with a body for each.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <mobil/engine/jobs.h>
#include "assets/fem/belly_solver.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"
#include "demo/lab/reference/reference.h"

namespace mobil {
namespace {

struct FigureMesh {
  std::string_view nodes;
  Cells cells;
};
constexpr FigureMesh coarse{"81", {2, 2, 8}}, fine{"525", {4, 4, 20}}, finest{"3321", {8, 8, 40}};
constexpr std::array steps_ms = {0.5, 1.0, 2.0, 3.0, 4.0};
constexpr double lanes = lane_count;

/// Cost of a second of the whole block of sixteen, s; none if the step is refused.
struct Cost {
  std::optional<Measured> block;
  double limit_s = 0;  // infinite for CAA
};

Mass mass_of(Method method) {
  return method == Method::implicit_central ? Mass::consistent : Mass::lumped;
}

Cost second(const BenchRun& run, const MuscleTemplate& muscle, Method method, double dt_s) {
  Cost cost{std::nullopt, INFINITY};
  if (method != Method::newmark) cost.limit_s = paper_limit_s(muscle, mass_of(method));
  if (dt_s > cost.limit_s) return cost;
  std::optional<BellySolver> solver;
  if (method != Method::explicit_central) solver = must(make_belly_solver(muscle, method, mass_of(method), dt_s));
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

/// Adds a cost, or a note if the step is above the method's limit.
void add_cost(BenchRun& run, const std::string& name, const Cost& cost) {
  if (!cost.block) {
    run.notes.push_back(fmt::format("{}: above the limit {:.2f} ms", name, cost.limit_s * 1e3));
    return;
  }
  run.add_time(name + ".us_per_simulated_s", *cost.block, lanes, 1e-6, "us").bound =
      fmt::format("a simulated second of one of sixteen; the block {:.0f} us, {:.0f} times real time",
                  cost.block->best_s * 1e6, 1 / cost.block->best_s);
}

/// Measures figure 18 on one mesh. With 81 nodes its first row is also figure 20 right.
std::map<double, Cost> figure18(BenchRun& run, const FigureMesh& mesh, const MuscleTemplate& muscle) {
  std::map<double, Cost> explicit_costs;
  for (const Method method : {Method::explicit_central, Method::implicit_central, Method::newmark}) {
    const std::string_view whole = method_name[static_cast<std::size_t>(method)];
    const std::string_view name = whole.substr(0, whole.find('-'));  // explicit, implicit or newmark
    for (const double ms : steps_ms) {
      const auto cost = second(run, muscle, method, ms * 1e-3);
      add_cost(run, fmt::format("figure18.{}{}.{:.1f}ms", name, mesh.nodes, ms), cost);
      if (method == Method::explicit_central) explicit_costs[ms] = cost;
    }
  }
  return explicit_costs;
}

/// Measures figure 20 left: explicit steps of 1 ms on three meshes, or of 0.9 of the limit if 1 ms is too long.
void figure20_left(BenchRun& run) {
  for (const FigureMesh& mesh : {coarse, fine, finest}) {
    const auto muscle = paper_block(mesh.cells);
    const auto cost = second(run, muscle, Method::explicit_central, 1e-3);
    add_cost(run, fmt::format("figure20.explicit{}.1.0ms", mesh.nodes), cost);
    if (cost.block) continue;
    const double dt_s = 0.9 * cost.limit_s;
    const auto shorter = second(run, muscle, Method::explicit_central, dt_s);
    add_cost(run, fmt::format("figure20.explicit{}.{:.2f}ms", mesh.nodes, dt_s * 1e3), shorter);
  }
}

/// Returns one second of elongation of the template's body, one sample a step.
std::vector<double> history(const MuscleTemplate& muscle, Method method, double dt_s) {
  std::optional<BellySolver> solver;
  if (method != Method::explicit_central) solver = must(make_belly_solver(muscle, method, mass_of(method), dt_s));
  return bench_histories(muscle, Stiffness::shared, dt_s, 1, solver ? &*solver : nullptr)[0];
}

/// Measures figure 19 as numbers, and the errors on which the claim of a fourth group rests.
void figure19(BenchRun& run) {
  const auto few = paper_block(coarse.cells), many = paper_block(fine.cells), most = paper_block({8, 8, 32});
  const auto newmark = history(many, Method::newmark, 1e-3), explicit2 = history(few, Method::explicit_central, 2e-3),
             explicit3 = history(few, Method::explicit_central, 3e-3),
             converged2 = history(most, Method::explicit_central, 5e-4),
             converged3 = history(most, Method::explicit_central, 7.5e-4),
             precise = history(few, Method::explicit_central, 1e-4);
  const auto add = [&](const char* name, const std::vector<double>& a, const std::vector<double>& b,
                       const std::string& what) {
    run.add_figure(name, history_error(a, b), "1", what + ", a second of elongation, rms over peak");
  };
  add("figure19.explicit81_to_newmark525", explicit2, newmark, "ECD 81 at 2 ms from CAA 525 at 1 ms");
  add("figure19.newmark525_to_converged", newmark, converged2, "CAA 525 at 1 ms from 2673 nodes at 0.5 ms");
  add("figure19.explicit81_2ms_to_converged", explicit2, converged2, "ECD 81 at 2 ms from 2673 nodes at 0.5 ms");
  add("figure19.explicit81_3ms_to_converged", explicit3, converged3, "ECD 81 at 3 ms from 2673 nodes at 0.75 ms");
  add("figure19.explicit81_2ms_to_own", explicit2, precise, "ECD 81 at 2 ms from itself at 0.1 ms");
  add("figure19.explicit81_3ms_to_own", explicit3, precise, "ECD 81 at 3 ms from itself at 0.1 ms");
}

/// "Also a four muscular group could be calculated with enough accuracy if Δt is increased to 0.003."
void four_groups(BenchRun& run, const std::map<double, Cost>& costs) {
  const double at2 = *costs.at(2.0).block->cpu_s / lanes, at3 = *costs.at(3.0).block->cpu_s / lanes;
  run.add_figure("figure20.four_groups_at_3ms_over_three_at_2ms", 4 * at3 / (3 * at2), "1",
                 fmt::format("of one leg; the paper's claim holds up to 1; {:.0f} times faster than real time",
                             1 / (4 * at3)));
}

constexpr double display_tick_s = 1.0 / 60;

/// Returns elongations of the body in lane `l` of the first block, in double precision.
std::vector<double> reference_history(const MuscleTemplate& muscle, Method method, double dt_s, double seconds,
                                      const BellyScale<Lanes<float>>& scale, const Lanes<float>& strength,
                                      std::size_t l) {
  auto belly = must(ReferenceBelly::make(muscle.mesh, muscle.terms,
                                         {.method = method,
                                          .dt_s = dt_s,
                                          .damping_per_s = muscle.options.damping_per_s,
                                          .across = static_cast<double>(scale.across[l]),
                                          .along = static_cast<double>(scale.along[l])}));
  const auto load_at = [&](double time_s) {
    const double pull = bench_pull_n(time_s) * static_cast<double>(strength[l]);
    return ReferenceLoad{.end = {bench_sideways * pull, 0, pull}};
  };
  std::vector<double> history;
  const long steps = std::lround(seconds / dt_s);
  for (long n = 0; n < steps; ++n) {
    belly.step(load_at(static_cast<double>(n) * dt_s), load_at(static_cast<double>(n + 1) * dt_s));
    history.push_back(belly.report().elongation_m);
  }
  return history;
}

/// One body for all people, or one for each, at one step of CAA.
struct Case {
  const char* name;
  double dt_s;
  std::uint32_t steps;  // a call
};
constexpr std::array cases = {Case{"fem.newmark81", paper_step_s, steps_a_tick},
                              Case{"fem.newmark81.60hz", display_tick_s, 1}};

constexpr std::array<std::size_t, 4> looked_at = {0, 5, 10, 15};  // lanes

/// Returns the largest error of the lanes in `looked_at`, compared with double precision at the same step.
double solver_error(const MuscleTemplate& muscle, Stiffness stiffness, double dt_s, const BellySolver& solver) {
  constexpr double seconds = 0.5;
  const BenchBellies bodies(muscle, stiffness, 1);
  const Histories ours = bench_histories(muscle, stiffness, dt_s, seconds, &solver);
  double largest = 0;
  for (const std::size_t l : looked_at) {
    const auto truth = reference_history(muscle, solver.method, dt_s, seconds, bodies.scale(), bodies.strength(), l);
    largest = std::max(largest, history_error(ours[l], truth));
  }
  return largest;
}

void bench_newmark(BenchRun& run, const MuscleTemplate& muscle) {
  for (const Case& c : cases) {
    auto solver = must(make_belly_solver(muscle, Method::newmark, Mass::lumped, c.dt_s));
    const auto tick_s = static_cast<float>(c.dt_s * c.steps);
    const auto measured = [&](Stiffness stiffness) {
      BenchBellies bellies(muscle, stiffness, crowd_blocks);
      return measure(run.rounds(15), [&] { bellies.tick(c.steps, tick_s, &solver); });
    };
    constexpr auto muscles = static_cast<double>(crowd_blocks * lane_count);
    for (const Stiffness stiffness : {Stiffness::shared, Stiffness::individual}) {
      const auto error = solver_error(muscle, stiffness, c.dt_s, solver);
      const bool shared = stiffness == Stiffness::shared;
      BenchResult& time = run.add_time(fmt::format("{}.{}.us_per_step", c.name, shared ? "shared" : "individual"),
                                       measured(stiffness), muscles * c.steps, 1e-6, "us");
      time.bound =
          fmt::format("{:.4g} us a simulated second; {}; {:.1e} off the same in double precision", time.value / c.dt_s,
                      shared ? "the factor solves it exactly"
                             : fmt::format("{} sweeps of conjugate gradients with one body's factor for bodies "
                                           "0.8-1.3 by 0.85-1.15",
                                           solver.sweeps),
                      error);
    }
  }
}

/// Measures the error of time steps, compared with explicit steps of 0.1 ms. The load rings at 7 Hz.
void bench_time_errors(BenchRun& run, const MuscleTemplate& muscle) {
  const BenchBellies body(muscle, Stiffness::shared, 1);
  const auto add = [&](const char* name, Method method, double dt_s, double fine_s) {
    const auto truth = reference_history(muscle, Method::explicit_central, fine_s, 1, body.scale(), body.strength(), 0);
    const auto stepped = reference_history(muscle, method, dt_s, 1, body.scale(), body.strength(), 0);
    run.add_figure(name, history_error(stepped, truth), "1",
                   fmt::format("rms over peak of one second's elongation, steps of {:.3g} ms against {:.3g} ms",
                               dt_s * 1e3, fine_s * 1e3));
  };
  add("fem.explicit81.time_error", Method::explicit_central, paper_step_s, paper_step_s / 20);
  add("fem.newmark81.time_error", Method::newmark, paper_step_s, paper_step_s / 20);
  add("fem.newmark81.60hz.time_error", Method::newmark, display_tick_s, display_tick_s / 160);
}

void bench_implicit_and_static(BenchRun& run, const MuscleTemplate& muscle) {
  const double limit_s = paper_limit_s(muscle, Mass::consistent);
  const double dt_s = 0.7 * limit_s;  // slim individuals have less than the template
  constexpr auto muscles = static_cast<double>(crowd_blocks * lane_count);
  for (const Stiffness stiffness : {Stiffness::shared, Stiffness::individual}) {
    const char* whose = stiffness == Stiffness::shared ? "shared" : "individual";
    const BellySolver implicit = must(make_belly_solver(muscle, Method::implicit_central, Mass::consistent, dt_s));
    const BellySolver still = must(make_belly_solver(muscle, Method::statics, Mass::lumped, dt_s));
    BenchBellies moving(muscle, stiffness, crowd_blocks), resting(muscle, stiffness, crowd_blocks);
    const Measured step =
        measure(run.rounds(15), [&] { moving.tick(steps_a_tick, static_cast<float>(dt_s * steps_a_tick), &implicit); });
    if (!moving.finite()) throw Stopped("implicit central: a displacement is not a number");
    run.add_time(fmt::format("fem.implicit81.{}.us_per_step", whose), step, muscles * steps_a_tick, 1e-6, "us").bound =
        fmt::format("exact for every body; limit {:.3g} ms, with the lumped mass {:.3g}", limit_s * 1e3,
                    paper_limit_s(muscle) * 1e3);
    const Measured solve = measure(run.rounds(15), [&] { resting.tick(1, paper_tick_s, &still); });
    run.add_time(fmt::format("fem.static81.{}.us_per_solve", whose), solve, muscles, 1e-6, "us").bound =
        stiffness == Stiffness::shared ? "the factor solves it exactly"
                                       : fmt::format("{} sweeps from the last answer", still.sweeps);
  }
}

}  // namespace

void bench_paper_figures(BenchRun& run) {
  const FloatMode mode;
  std::map<double, Cost> explicit_costs;
  for (const FigureMesh& mesh : {fine, coarse}) {
    const auto muscle = paper_block(mesh.cells);
    explicit_costs = figure18(run, mesh, muscle);
  }
  figure19(run);
  figure20_left(run);
  four_groups(run, explicit_costs);
}

void bench_fem_implicit(BenchRun& run) {
  const auto muscle = paper_block({2, 2, 8});
  bench_newmark(run, muscle);
  bench_time_errors(run, muscle);
  bench_implicit_and_static(run, muscle);
}

}  // namespace mobil
