// Table 1 of the paper: what a walk of so many steps costs, theirs beside ours. 80 kg, 1.80 m, 5 km/h; no muscles.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include <mobil/simulation.h>
#include "demo/lab/bench/bench.h"

namespace mobil {
namespace {

/// As printed, on a Pentium 4 at 2.8 GHz, 25 frames a second.
struct PaperRow {
  int steps;
  double simulated_s;
  int frames;
  double cpu_s;
};

constexpr std::array paper_rows = {PaperRow{3, 1.27, 30, 0.078}, PaperRow{4, 1.84, 44, 0.144},
                                   PaperRow{5, 2.4, 58, 0.174}, PaperRow{10, 5.2, 128, 0.312},
                                   PaperRow{20, 10.76, 267, 0.612}};

constexpr double frame_s = 0.04;

/// Spawns the person of the table and walks until so many steps are done; returns the frames that took.
Result<int> walk_steps(int steps) {
  Simulation simulation({.tick_s = frame_s});
  const auto human = simulation.spawn({.height_m = 1.80F, .mass_kg = 80.0F}, {.speed_m_s = 5.0F / 3.6F});
  if (!human) return tl::unexpected(human.error());
  const double duration = simulation.get<StepPlan>(*human)->duration_s;
  const int frames = static_cast<int>(std::floor(steps * duration / frame_s));
  for (int i = 0; i < frames; ++i) simulation.tick();
  return frames;
}

}  // namespace

Result<void> bench_table1(BenchRun& run) {
  for (const PaperRow& row : paper_rows) {
    auto frames = walk_steps(row.steps);
    if (!frames) return tl::unexpected(frames.error());
    const Measured time = measure(20, [&] { frames = walk_steps(row.steps); });
    BenchResult& result = run.add_time(fmt::format("table1.{}_steps.us", row.steps), time, 1, 1e-6, "us");
    result.bound = fmt::format(
        "{:.2f} s simulated, {} frames; the paper: {:.2f} s, {} frames, {:.3f} s of a Pentium 4 "
        "at 2.8 GHz, {:.0f} times as long",
        *frames * frame_s, *frames, row.simulated_s, row.frames, row.cpu_s, row.cpu_s / time.best_s);
  }
  return {};
}

}  // namespace mobil
