#include "demo/lab/bench/bench_crowd.h"

#include <algorithm>
#include <optional>

#include <mobil/engine/access.h>
#include <mobil/engine/world.h>
#include <mobil/schedule.h>
#include "demo/program/must.h"
#include "demo/program/progress.h"

namespace mobil {
namespace {

constexpr double min_cpu_s = 20e-6;    // reading a thread's processor time takes about 0.5 us
constexpr double settling_s = 2;       // until people no longer step in time with each other

}  // namespace

BenchCrowd::BenchCrowd(std::size_t people) {
  ProgressBar progress("spawning", people);
  std::vector<double> wall;
  double wall_s = 0, cpu_s = 0;
  for (std::size_t i = 0; i < people; ++i) {
    std::uint8_t draw = 0;
    const auto person = must(crowd_walker(seed, i, draw));
    const double wall_start = wall_now_s(), cpu_start = thread_cpu_now_s();
    const auto entity = must(simulation_.spawn(person.body, person.gait));
    const double wall_end = wall_now_s(), cpu_end = thread_cpu_now_s();
    wall.push_back(wall_end - wall_start);
    wall_s += wall_end - wall_start;
    cpu_s += cpu_end - cpu_start;
    people_.push_back(entity);
    asked_.push_back(person);
    drawn_again_ += draw;
    progress.at(i + 1);
  }
  const auto count = static_cast<double>(people);
  spawn_ = {wall_s / count, median(wall), cpu_s / count};
}

const Table* BenchCrowd::table_of(const System& system) const {
  std::vector<Bound> bound(system.parameters);
  for (const Table& table : simulation_.world().tables()) {
    if (table.row_count() > 0 && system.bind(simulation_.world(), table, bound.data())) return &table;
  }
  return nullptr;
}

const std::map<std::string, Measured, std::less<>>& BenchCrowd::steady_ticks() {
  if (!steady_.empty()) return steady_;
  Schedule& schedule = simulation_.schedule();
  const auto settling = static_cast<int>(settling_s / simulation_.tick_s());
  const double start_s = wall_now_s();
  for (int i = 0; i < settling; ++i) simulation_.tick();
  const int ticks = runs_a_repeat((wall_now_s() - start_s) / settling);

  const auto run = [&] {
    for (int i = 0; i < ticks; ++i) simulation_.tick();
  };
  const std::size_t systems = schedule.systems().size();
  std::vector<std::vector<double>> wall(systems), cpu(systems);
  for (int repeat = 0; repeat < bench_repeats; ++repeat) {
    schedule.reset_timings();
    run();
    for (std::size_t s = 0; s < systems; ++s) wall[s].push_back(schedule.timings()[s].seconds / ticks);
    // in separate ticks, because reading the time costs time
    const auto cpu_s = cpu_of(run);
    for (std::size_t s = 0; s < systems; ++s) cpu[s].push_back(cpu_s[s] / ticks);
  }
  for (std::size_t s = 0; s < systems; ++s) {
    const System& system = schedule.systems()[s];
    if (table_of(system) == nullptr) continue;
    const double cpu_s = std::ranges::min(cpu[s]);
    steady_[system.name] = {std::ranges::min(wall[s]), median(wall[s]),
                            cpu_s > min_cpu_s ? std::optional(cpu_s) : std::nullopt};
  }
  return steady_;
}

std::vector<double> BenchCrowd::cpu_of(const std::function<void()>& work) {
  Schedule& schedule = simulation_.schedule();
  schedule.reset_timings();
  schedule.measure_with(&thread_cpu_now_s);
  work();
  schedule.measure_with(nullptr);
  std::vector<double> seconds;
  for (const Timing& timing : schedule.timings()) seconds.push_back(timing.seconds);
  return seconds;
}

std::size_t BenchCrowd::bytes_per_person(std::string_view name) {
  for (const System& system : simulation_.schedule().systems()) {
    if (system.name != name) continue;
    const Table* table = table_of(system);
    if (table == nullptr) return 0;
    std::size_t words = 0;
    for (const Access& access : system.accesses) {
      if (access.mode != Access::Mode::read && access.mode != Access::Mode::write) continue;
      const ComponentId* part = find_component(table->key(), access.id);
      if (part != nullptr) words += part->value;
    }
    return 4 * words;
  }
  return 0;
}

void BenchCrowd::change_speeds(std::uint32_t round, float forward_swing) {
  for (std::size_t i = 0; i < people_.size(); ++i) {
    CrowdRandom random(seed, i, 0x1000 + round);
    asked_[i].gait.speed_m_s = crowd_speed(random);
    asked_[i].gait.style.forward_swing = forward_swing;
    must(simulation_.set_gait(people_[i], asked_[i].gait));
  }
}

}  // namespace mobil
