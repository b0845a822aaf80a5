// Cost of a change of method: the figures by which level of detail plans its switches (switch_us, accuracy_table.h).

#include <algorithm>

#include <mobil/lod.h>
#include <mobil/simulation.h>
#include "demo/lab/bench/bench.h"

namespace mobil {

namespace {

constexpr std::size_t people = 64;

/// Measures switches of people's hamstrings, both legs, active or not, from the dearest level to each other one and
/// back, `rounds` times.
void bench_levels(BenchRun& run, bool active) {
  Simulation simulation;
  std::vector<Entity> walkers;
  LegMuscles choice;
  choice.muscles = MuscleSet(1);
  if (active) choice.activation = ExcitationSource::phase;
  for (std::size_t i = 0; i < people; ++i) {
    const auto walker = must(simulation.spawn({}, {.speed_m_s = 1 + 0.01F * static_cast<float>(i)}));
    must(simulation.set_muscles(walker, choice));
    walkers.push_back(walker);
  }
  const auto all_to = [&](std::size_t level) {
    for (const Entity walker : walkers)
      must(simulation.set_method(walker, Muscle::hamstrings, level_method(level, true, active)));
  };
  const LodLevels& levels = levels_of(active);
  const std::size_t full = level_count - 1;
  for (std::size_t level = 0; level < level_count; ++level) {
    const bool fine = levels[level].cells[2] > ModalOptions{}.cells[2];
    if (run.quick && fine) continue;  // its basis takes a second to make
    const std::size_t from = level == full ? 0 : full;
    all_to(level);  // makes its shared data
    std::vector<double> wall_s;
    for (int round = 0; round < run.rounds(5); ++round) {
      all_to(from);
      simulation.tick();
      const double start_s = wall_now_s();
      all_to(level);
      wall_s.push_back(wall_now_s() - start_s);
    }
    const Measured time{*std::min_element(wall_s.begin(), wall_s.end()), median(wall_s)};
    const std::string name(active && level == 0 ? "active-none" : levels[level].name);
    run.add_time("lod.us_per_switch." + name, time, people, 1e-6, "us").bound =
        "both legs; to " + std::string(levels[level].name) + " from " + std::string(levels[from].name);
  }
}

}  // namespace

void bench_lod(BenchRun& run) {
  bench_levels(run, false);
  bench_levels(run, true);
}

}  // namespace mobil
