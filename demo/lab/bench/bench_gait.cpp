// The walkers' own systems over a crowd: the gait clock, solving a step again, the pose of 48 segments. Also table 1 of
// the paper: the cost of a walk of a number of steps, compared with ours (80 kg, 1.80 m, 5 km/h, no muscles).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <mobil/components/gait.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/world.h>
#include <mobil/pose_writer.h>
#include <mobil/schedule.h>
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_crowd.h"

namespace mobil {
namespace {

/// Returns the number of rows that a packed system has processed, if its schedule counts them.
template <class T>
std::optional<std::uint64_t> rows_of(const T* timing) {
  if constexpr (requires { std::uint64_t{timing->rows}; }) {
    if (timing != nullptr) return timing->rows;
  }
  return std::nullopt;
}

/// Adds the time of one system for a person and tick in the crowd, and in the small crowd. `bytes` is the data it must
/// move for one person.
void add_system(BenchRun& run, std::string_view system, const std::string& name, double bytes) {
  const auto crowd = run.crowd();
  const auto small = run.small_crowd();
  const auto& times = crowd->steady_ticks();
  const auto time = times.find(system);
  if (time == times.end()) {
    run.notes.push_back(fmt::format("{}: not measured, as there is no system '{}' that has people", name, system));
    return;
  }
  const double per_person_s = time->second.best_s / static_cast<double>(crowd->size());
  BenchResult& large =
      run.add_time(name + ".us_per_person_tick", time->second, static_cast<double>(crowd->size()), 1e-6, "us");
  large.of_bandwidth = bytes / per_person_s * 1e-9 / run.machine.bandwidth_gbps;
  large.bound = fmt::format("{:.0f} bytes a person", bytes);
  if (small == nullptr) return;

  const auto& small_times = small->steady_ticks();
  const auto small_time = small_times.find(system);
  if (small_time == small_times.end()) return;
  const Measured& in_cache = small_time->second;
  const auto people = static_cast<double>(small->size());
  const double ratio = per_person_s / (in_cache.best_s / people);
  large.bound += ratio > 1.25 ? fmt::format("; memory: {:.1f} times the small crowd's", ratio)
                              : std::string("; instructions: no dearer than the small crowd's");
  run.add_time(name + ".small_crowd.us_per_person_tick", in_cache, people, 1e-6, "us").bound =
      at_peak(run.machine, in_cache.best_s / people);
}

/// Changes the speed of all people, so that their next steps are solved again.
void add_resolve(BenchRun& run, BenchCrowd& crowd, std::string_view name, float forward_swing) {
  static constexpr auto solver = "replan";
  constexpr int rounds = 5;
  constexpr double longest_change_s = 1.5;
  const Schedule& schedule = crowd.simulation().schedule();
  const auto ticks = static_cast<int>(longest_change_s / crowd.simulation().tick_s());
  std::vector<double> wall, cpu;
  std::uint64_t solved = 0;
  for (int round = 0; round < rounds && rows_of(schedule.timing(solver)); ++round) {
    crowd.change_speeds(static_cast<std::uint32_t>(round), forward_swing);
    const auto cpu_s = crowd.cpu_of([&] {
      for (int i = 0; i < ticks; ++i) crowd.simulation().tick();
    });
    const Timing& timing = *schedule.timing(solver);
    const std::uint64_t steps = *rows_of(&timing);
    if (steps == 0) continue;
    solved += steps;
    // the search for people who need a new step, in all ticks, is in the wall-clock time
    wall.push_back(timing.seconds / static_cast<double>(steps));
    cpu.push_back(cpu_s[static_cast<std::size_t>(&timing - schedule.timings().data())] / static_cast<double>(steps));
  }
  if (solved == 0) {
    run.notes.push_back(fmt::format("{}: not measured, as no step was solved after a change of speed", name));
    return;
  }
  BenchResult& result =
      run.add_time(std::string(name), {std::ranges::min(wall), median(wall), std::ranges::min(cpu)}, 1, 1e-6, "us");
  result.bound = fmt::format("{}; {:.0f} steps a tick", at_peak(run.machine, result.value * 1e-6),
                             static_cast<double>(solved) / (rounds * ticks));
}

/// Writes whole poses of all people to a host's memory: as the tables hold them, and halfway to the next tick.
void add_poses(BenchRun& run, BenchCrowd& crowd, const std::string& name) {
  PoseWriter writer;
  constexpr std::size_t floats_a_segment = 7;
  std::vector<float> out(crowd.size() * segment_count * floats_a_segment);
  const World& world = crowd.simulation().world();
  for (const bool between : {false, true}) {
    const double ahead_s = between ? 0.5 * crowd.simulation().tick_s() : 0.0;
    Result<void> done;
    const Measured time = measure_short(
        [&] { done = writer.write(world, crowd.people(), ahead_s, {}, {std::as_writable_bytes(std::span(out))}); });
    must(done);
    run.add_time(name + (between ? ".between_ticks.us_per_person" : ".us_per_person"), time,
                 static_cast<double>(crowd.size()), 1e-6, "us")
        .bound = "48 places and quaternions in a host's memory";
  }
}

/// Printed row, on a Pentium 4 at 2.8 GHz, 25 frames a second.
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

/// Spawns the table's person and walks until so many steps are done. Returns the number of frames.
int walk_steps(int steps) {
  Simulation simulation({.tick_s = frame_s});
  const auto person = must(simulation.spawn({.height_m = 1.80F, .mass_kg = 80.0F}, {.speed_m_s = 5.0F / 3.6F}));
  const double duration = simulation.get<StepPlan>(person)->duration_s;
  const int frames = static_cast<int>(std::floor(steps * duration / frame_s));
  for (int i = 0; i < frames; ++i) simulation.tick();
  return frames;
}

}  // namespace

void bench_gait(BenchRun& run) {
  // the clock reads duration and length of the step's plan
  const double bytes = 2.0 * sizeof(GaitState<float>) + 2 * sizeof(float);
  add_system(run, "gait", "gait", bytes);
  BenchCrowd& crowd = *run.crowd();
  BenchResult& spawn = run.add_time("gait.us_per_spawn", crowd.spawn(), 1, 1e-6, "us");
  spawn.bound = "the mean of all: body, gait, first step, first pose";
  if (crowd.drawn_again() > 0) {
    run.notes.push_back(fmt::format("gait.us_per_spawn: {} of {} could not walk as drawn and were drawn again",
                                    crowd.drawn_again(), crowd.size()));
  }
  add_resolve(run, crowd, "gait.us_per_resolve_forward_swing", 1);
  add_resolve(run, crowd, "gait.us_per_resolve", 0);
}

void bench_kinematics(BenchRun& run) {
  const auto crowd = run.crowd();
  const auto bytes = [&](std::string_view system) { return static_cast<double>(crowd->bytes_per_person(system)); };
  add_system(run, "kinematics", "kinematics", bytes("kinematics"));
  add_system(run, "centre of mass", "centre_of_mass", bytes("centre of mass"));
  add_poses(run, *crowd, "poses");
  const auto small = run.small_crowd();
  if (small != nullptr) add_poses(run, *small, "poses.small_crowd");
}

void bench_table1(BenchRun& run) {
  for (const PaperRow& row : paper_rows) {
    auto frames = walk_steps(row.steps);
    const Measured time = measure(20, [&] { frames = walk_steps(row.steps); });
    BenchResult& result = run.add_time(fmt::format("table1.{}_steps.us", row.steps), time, 1, 1e-6, "us");
    result.bound = fmt::format(
        "{:.2f} s simulated, {} frames; the paper: {:.2f} s, {} frames, {:.3f} s of a Pentium 4 "
        "at 2.8 GHz, {:.0f} times as long",
        frames * frame_s, frames, row.simulated_s, row.frames, row.cpu_s, row.cpu_s / time.best_s);
  }
}

}  // namespace mobil
