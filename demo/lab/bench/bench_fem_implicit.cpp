// Methods that solve: constant average acceleration (CAA), implicit central differences (ICD), static answers. What a
// step costs with one body for all and with everybody's own, and how far off it then is.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"
#include "demo/lab/reference/reference.h"

namespace mobil {
namespace {

constexpr double display_tick_s = 1.0 / 60;

/// Elongations of the body in lane `l` of the first block, in double precision.
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

/// One body for all, or everybody's own, at one step of CAA.
struct Case {
  const char* name;
  double dt_s;
  std::uint32_t steps;  // a call
};
constexpr std::array cases = {Case{"fem.caa81", paper_step_s, steps_a_tick}, Case{"fem.caa81.60hz", display_tick_s, 1}};

constexpr std::array<std::size_t, 4> looked_at = {0, 5, 10, 15};  // lanes

/// Largest error of the lanes looked at against double precision at the same step.
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

void bench_caa(BenchRun& run, const MuscleTemplate& muscle) {
  for (const Case& c : cases) {
    auto solver = must(make_belly_solver(muscle, Method::caa, Mass::lumped, c.dt_s));
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

/// What the steps themselves cost in accuracy, against explicit steps of 0.1 ms; the load rings at 7 Hz.
void bench_time_errors(BenchRun& run, const MuscleTemplate& muscle) {
  const BenchBellies body(muscle, Stiffness::shared, 1);
  const auto add = [&](const char* name, Method method, double dt_s, double fine_s) {
    const auto truth = reference_history(muscle, Method::ecd, fine_s, 1, body.scale(), body.strength(), 0);
    const auto coarse = reference_history(muscle, method, dt_s, 1, body.scale(), body.strength(), 0);
    run.add_figure(name, history_error(coarse, truth), "1",
                   fmt::format("rms over peak of one second's elongation, steps of {:.3g} ms against {:.3g} ms",
                               dt_s * 1e3, fine_s * 1e3));
  };
  add("fem.ecd81.time_error", Method::ecd, paper_step_s, paper_step_s / 20);
  add("fem.caa81.time_error", Method::caa, paper_step_s, paper_step_s / 20);
  add("fem.caa81.60hz.time_error", Method::caa, display_tick_s, display_tick_s / 160);
}

void bench_icd_and_static(BenchRun& run, const MuscleTemplate& muscle) {
  const double limit_s = paper_limit_s(muscle, Mass::consistent);
  const double dt_s = 0.7 * limit_s;  // slim individuals have less than the template
  constexpr auto muscles = static_cast<double>(crowd_blocks * lane_count);
  for (const Stiffness stiffness : {Stiffness::shared, Stiffness::individual}) {
    const char* whose = stiffness == Stiffness::shared ? "shared" : "individual";
    const BellySolver icd = must(make_belly_solver(muscle, Method::icd, Mass::consistent, dt_s));
    const BellySolver still = must(make_belly_solver(muscle, Method::statics, Mass::lumped, dt_s));
    BenchBellies moving(muscle, stiffness, crowd_blocks), resting(muscle, stiffness, crowd_blocks);
    const Measured step =
        measure(run.rounds(15), [&] { moving.tick(steps_a_tick, static_cast<float>(dt_s * steps_a_tick), &icd); });
    if (!moving.finite()) throw Stopped("icd: a displacement is not a number");
    run.add_time(fmt::format("fem.icd81.{}.us_per_step", whose), step, muscles * steps_a_tick, 1e-6, "us").bound =
        fmt::format("exact for every body; limit {:.3g} ms, with the lumped mass {:.3g}", limit_s * 1e3,
                    paper_limit_s(muscle) * 1e3);
    const Measured solve = measure(run.rounds(15), [&] { resting.tick(1, paper_tick_s, &still); });
    run.add_time(fmt::format("fem.static81.{}.us_per_solve", whose), solve, muscles, 1e-6, "us").bound =
        stiffness == Stiffness::shared ? "the factor solves it exactly"
                                       : fmt::format("{} sweeps from the last answer", still.sweeps);
  }
}

}  // namespace

void bench_fem_implicit(BenchRun& run) {
  const auto muscle = paper_block({2, 2, 8});
  bench_caa(run, muscle);
  bench_time_errors(run, muscle);
  bench_icd_and_static(run, muscle);
}

}  // namespace mobil
