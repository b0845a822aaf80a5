// Cost of a change of method: the figures by which level of detail plans its switches (switch_us, accuracy_table.h).

#include <algorithm>

#include <mobil/lod.h>
#include <mobil/simulation.h>
#include "demo/lab/bench/bench.h"

namespace mobil {

namespace {

constexpr std::size_t people = 64;

/// Both legs' hamstrings of people, pulling or not, who begin with the ladder's dearest rung; `rounds` times there and
/// back.
void bench_ladder(BenchRun& run, bool living) {
  Simulation simulation;
  std::vector<Entity> walkers;
  LegMuscles choice;
  choice.muscles = MuscleSet(1);
  if (living) choice.activation = ExcitationSource::phase;
  for (std::size_t i = 0; i < people; ++i) {
    const auto walker = must(simulation.spawn({}, {.speed_m_s = 1 + 0.01F * static_cast<float>(i)}));
    must(simulation.set_muscles(walker, choice));
    walkers.push_back(walker);
  }
  const auto all_to = [&](std::size_t rung) {
    for (const Entity walker : walkers)
      must(simulation.set_method(walker, Muscle::hamstrings, rung_method(rung, true, living)));
  };
  const Ladder& ladder = rungs_of(living);
  const std::size_t full = rung_count - 1;
  for (std::size_t rung = 0; rung < rung_count; ++rung) {
    const bool fine = ladder[rung].cells[2] > ReducedChoice{}.cells[2];
    if (run.quick && fine) continue;  // its basis takes a second to make
    const std::size_t from = rung == full ? 0 : full;
    all_to(rung);  // what it shares is made
    std::vector<double> wall_s;
    for (int round = 0; round < run.rounds(5); ++round) {
      all_to(from);
      simulation.tick();
      const double start_s = wall_now_s();
      all_to(rung);
      wall_s.push_back(wall_now_s() - start_s);
    }
    const Measured time{*std::min_element(wall_s.begin(), wall_s.end()), median(wall_s)};
    const std::string name(living && rung == 0 ? "living-none" : ladder[rung].name);
    run.add_time("relevance.us_per_switch." + name, time, people, 1e-6, "us").bound =
        "both legs; to " + std::string(ladder[rung].name) + " from " + std::string(ladder[from].name);
  }
}

}  // namespace

void bench_relevance(BenchRun& run) {
  bench_ladder(run, false);
  bench_ladder(run, true);
}

}  // namespace mobil
