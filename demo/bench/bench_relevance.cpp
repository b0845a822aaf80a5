// What a change of method takes: the figures that Relevance plans its updates by (switch_us, accuracy_table.h).

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "demo/bench/bench.h"
#include "demo/measure/measure.h"
#include "systems/relevance/relevance.h"
#include "systems/simulation.h"

namespace mobil {

/// Both legs' hamstrings of people who begin with the paper's method; `rounds` times there and back.
Result<void> bench_relevance(BenchRun& run) {
  constexpr std::size_t people = 64;
  Simulation simulation;
  std::vector<Entity> walkers;
  LegMuscles choice;
  choice.muscles = MuscleSet(1);
  for (std::size_t i = 0; i < people; ++i) {
    const auto walker = simulation.spawn({}, {.speed_m_s = 1 + 0.01F * static_cast<float>(i)});
    if (!walker) return tl::unexpected(walker.error());
    if (auto added = simulation.add_leg_muscles(*walker, choice); !added) return added;
    walkers.push_back(*walker);
  }
  const auto all_to = [&](std::size_t rung) -> Result<void> {
    for (const Entity walker : walkers) {
      if (auto done = simulation.set_method(walker, Muscle::hamstrings, rung_method(rung, true)); !done) return done;
    }
    return {};
  };
  const std::size_t full = rung_count - 1;
  for (std::size_t rung = 0; rung < rung_count; ++rung) {
    const bool fine = rungs[rung].cells[2] > ReducedChoice{}.cells[2];
    if (run.quick && fine) continue;  // its basis takes a second to make
    const std::size_t from = rung == full ? 0 : full;
    if (auto done = all_to(rung); !done) return done;  // what it shares is made
    std::vector<double> wall_s;
    for (int round = 0; round < run.rounds(5); ++round) {
      if (auto done = all_to(from); !done) return done;
      simulation.tick();
      const double start_s = wall_now_s();
      if (auto done = all_to(rung); !done) return done;
      wall_s.push_back(wall_now_s() - start_s);
    }
    const Measured time{*std::min_element(wall_s.begin(), wall_s.end()), median(wall_s)};
    run.add_time("relevance.us_per_switch." + std::string(rungs[rung].name), time, people, 1e-6, "us").bound =
        "both legs; to " + std::string(rungs[rung].name) + " from " + std::string(rungs[from].name);
  }
  return {};
}

}  // namespace mobil
