#include "demo/bench_crowd.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "engine/access.h"

namespace mobil {
namespace {

constexpr double least_cpu_s = 20e-6;  // asking a thread for its time on a processor takes about 0.5 us
constexpr double settling_s = 2;       // until nobody steps in time with anybody else

/// Steele, Lea & Flood's SplitMix64: the same numbers on every machine.
class Random {
 public:
  Random(std::size_t person, std::uint32_t draw) : state_(BenchCrowd::seed << 56 ^ std::uint64_t{draw} << 40 ^ person) {
    next();
  }
  float even(float low, float high) { return low + (high - low) * unit(); }
  /// A sum of twelve even numbers, which is bell-shaped enough and exact everywhere.
  float bell(float mean, float deviation) {
    float sum = -6;
    for (int i = 0; i < 12; ++i) sum += unit();
    return mean + deviation * std::clamp(sum, -2.5F, 2.5F);
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }
  float unit() { return static_cast<float>(next() >> 40) * 0x1p-24F; }

  std::uint64_t state_;
};

float drawn_speed(Random& random) {
  return random.bell(1.35F, 0.15F);
}

/// On a terminal, after the first second: how many are there.
class Progress {
 public:
  explicit Progress(std::size_t total) : total_(total), next_s_(wall_now_s() + 1) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void at(std::size_t done) {
    if (!terminal_ || wall_now_s() < next_s_) return;
    next_s_ = wall_now_s() + 0.1;
    shown_ = true;
    fmt::print(stderr, "\rspawning [{:<40}] {}/{}", std::string(40 * done / total_, '='), done, total_);
  }

 private:
  std::size_t total_;
  double next_s_;
  bool terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
};

}  // namespace

BenchPerson bench_person(std::size_t i, std::uint32_t draw) {
  Random random(i, draw);
  BenchPerson person;
  person.body.height_m = random.bell(1.72F, 0.09F);
  person.body.mass_kg = random.bell(24, 3) * person.body.height_m * person.body.height_m;
  person.body.biotype = {random.bell(3, 0.7F), random.bell(4, 0.7F), random.bell(3, 0.7F)};
  person.body.constitution = static_cast<Constitution>(std::min(3, static_cast<int>(random.even(0, 4))));
  person.gait.speed_m_s = drawn_speed(random);
  for (const GaitParameter& parameter : gait_parameters) {
    float& value = person.gait.style.*parameter.value;
    value = std::clamp(value * random.even(0.9F, 1.1F), parameter.low, parameter.high);
  }
  return person;
}

BenchCrowd::BenchCrowd()
    : simulation_({.jobs = Jobs{&meter_, [](void* user, std::size_t count, Jobs::Body body, void* context) {
                                  auto& meter = *static_cast<CpuMeter*>(user);
                                  if (!meter.on) return body(context, 0, count);
                                  const double start = thread_cpu_now_s();
                                  body(context, 0, count);
                                  // the system at work is the first that has run no more often than the last one
                                  const auto timings = meter.schedule->timings();
                                  const auto at = std::ranges::find(timings, timings.back().calls, &Timing::calls);
                                  meter.system_s[static_cast<std::size_t>(at - timings.begin())] +=
                                      thread_cpu_now_s() - start;
                                }}}) {
  meter_.schedule = &simulation_.schedule();
}

Result<std::shared_ptr<BenchCrowd>> BenchCrowd::make(std::size_t humans) {
  std::shared_ptr<BenchCrowd> crowd(new BenchCrowd);
  if (auto done = crowd->spawn(humans); !done) return tl::unexpected(done.error());
  return crowd;
}

Result<void> BenchCrowd::spawn(std::size_t humans) {
  constexpr std::uint32_t most_draws = 20;
  Progress progress(humans);
  std::vector<double> wall;
  double wall_s = 0, cpu_s = 0;
  for (std::size_t i = 0; i < humans; ++i) {
    for (std::uint32_t draw = 0;; ++draw) {
      const BenchPerson person = bench_person(i, draw);
      const double wall_start = wall_now_s(), cpu_start = thread_cpu_now_s();
      const auto entity = simulation_.spawn(person.body, person.gait);
      const double wall_end = wall_now_s(), cpu_end = thread_cpu_now_s();
      if (entity) {
        wall.push_back(wall_end - wall_start);
        wall_s += wall_end - wall_start;
        cpu_s += cpu_end - cpu_start;
        people_.push_back(*entity);
        asked_.push_back(person);
        break;
      }
      ++drawn_again_;
      if (draw + 1 == most_draws) {
        return fail(
            fmt::format("person {} of the crowd was refused {} times: {}", i, most_draws, entity.error().message));
      }
    }
    progress.at(i + 1);
  }
  const auto count = static_cast<double>(humans);
  spawn_ = {wall_s / count, median(wall), cpu_s / count};
  return {};
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
    // in ticks of its own, as asking for it takes time too
    const auto cpu_s = cpu_of(run);
    for (std::size_t s = 0; s < systems; ++s) cpu[s].push_back(cpu_s[s] / ticks);
  }
  for (std::size_t s = 0; s < systems; ++s) {
    const System& system = schedule.systems()[s];
    if (table_of(system) == nullptr) continue;
    const double cpu_s = std::ranges::min(cpu[s]);
    steady_[system.name] = {std::ranges::min(wall[s]), median(wall[s]),
                            cpu_s > least_cpu_s ? std::optional(cpu_s) : std::nullopt};
  }
  return steady_;
}

std::vector<double> BenchCrowd::cpu_of(const std::function<void()>& work) {
  simulation_.schedule().reset_timings();
  meter_.system_s.assign(simulation_.schedule().systems().size(), 0);
  meter_.on = true;
  work();
  meter_.on = false;
  return meter_.system_s;
}

std::size_t BenchCrowd::bytes_per_human(std::string_view name) {
  for (const System& system : simulation_.schedule().systems()) {
    if (system.name != name) continue;
    const Table* table = table_of(system);
    if (table == nullptr) return 0;
    std::size_t words = 0;
    for (const Access& access : system.accesses) {
      if (access.mode != Access::Mode::read && access.mode != Access::Mode::write) continue;
      const KeyPart* part = find_part(table->key(), access.id);
      if (part != nullptr) words += part->value;
    }
    return 4 * words;
  }
  return 0;
}

Result<void> BenchCrowd::change_speeds(std::uint32_t round) {
  for (std::size_t i = 0; i < people_.size(); ++i) {
    Random random(i, 0x1000 + round);
    asked_[i].gait.speed_m_s = drawn_speed(random);
    if (auto done = simulation_.change_gait(people_[i], asked_[i].gait); !done) return done;
  }
  return {};
}

}  // namespace mobil
