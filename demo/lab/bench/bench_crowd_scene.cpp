#include "demo/lab/bench/bench_crowd_scene.h"

#include <algorithm>

#include "demo/scene/crowd_people.h"

namespace mobil {
namespace {

constexpr int settling_ticks = 90;  // the second step shows that the third is like it

}  // namespace

LegMuscles bench_reduced_muscles() {
  LegMuscles choice;
  choice.method = Method::reduced;
  choice.reduced.control_points = false;
  choice.reduced.reported = false;
  return choice;
}

Jobs BenchScene::jobs() {
  return {&turn_,
          [](void* user, std::size_t count, Jobs::Body body, void* context) {
            Turn& turn = *static_cast<Turn*>(user);
            const double start_s = wall_now_s();
            if (turn.now == nullptr) {
              body(context, 0, count);
            } else {
              const Jobs all = turn.now->jobs();
              all.parallel_for(all.user, count, body, context);
            }
            turn.handed_out_s += wall_now_s() - start_s;
            ++turn.loops;
          },
          static_cast<std::size_t>(Threads().count())};
}

const Threads& BenchScene::pool(int threads) {
  return pools_.try_emplace(threads, threads).first->second;
}

BenchScene::BenchScene(const LegMuscles& choice) : choice_(choice), simulation_({.jobs = jobs()}) {}

Result<void> BenchScene::grow_to(std::size_t humans) {
  constexpr std::size_t at_once = 1000;
  if (auto done = simulation_.prepare(choice_); !done) return done;
  std::vector<SpawnRequest> requests;
  std::vector<Entity> entities;
  double spent_s = 0;
  const std::size_t before = people_.size();
  while (people_.size() < humans) {
    requests.clear();
    while (requests.size() < std::min(at_once, humans - people_.size())) {
      std::uint8_t draw = 0;
      const auto person = crowd_walker(seed, drawn_++, draw);
      if (!person) return tl::unexpected(person.error());
      requests.push_back({.body = person->body, .gait = person->gait, .muscles = choice_});
    }
    entities.resize(requests.size());
    const double start_s = process_cpu_now_s();
    if (auto done = simulation_.spawn(requests, entities); !done) return done;
    spent_s += process_cpu_now_s() - start_s;
    people_.insert(people_.end(), entities.begin(), entities.end());
  }
  if (people_.size() > before) spawn_s_ = spent_s / static_cast<double>(people_.size() - before);
  for (int i = 0; i < settling_ticks; ++i) simulation_.tick();
  return {};
}

Result<void> BenchScene::compact() {
  const auto done = simulation_.compact(people_);
  if (!done) return tl::unexpected(done.error());
  if (*done < people_.size()) return fail("somebody does not become compact");
  simulation_.tick();
  return {};
}

Result<void> BenchScene::expand() {
  return simulation_.expand(people_);
}

double BenchScene::bytes_per_human() const {
  std::size_t bytes = 0;
  for (const Table& table : simulation_.world().tables())
    bytes += table.row_count() * (table.block_bytes() / lane_count);
  return static_cast<double>(bytes) / static_cast<double>(size());
}

void BenchScene::measure(int threads, int ticks, BenchTick& best) {
  Schedule& schedule = simulation_.schedule();
  if (threads > 1) turn_.now = &pool(threads);
  Series& series = series_[threads];
  if (best.system_s.empty()) series = {};
  best.system_s.resize(schedule.systems().size(), 1e9);
  turn_.loops = 0;
  for (int i = 0; i < ticks; ++i) {
    turn_.handed_out_s = 0;
    const double wall = wall_now_s(), cpu = process_cpu_now_s();
    simulation_.tick();
    series.cpu.push_back(process_cpu_now_s() - cpu);
    series.wall.push_back(wall_now_s() - wall);
    series.serial_share.push_back(1 - turn_.handed_out_s / series.wall.back());
  }
  best.loops = static_cast<double>(turn_.loops) / ticks;
  // Reading a thread's clock after every block slows a small crowd's tick by a tenth or more. Systems are therefore
  // timed in ticks of their own.
  schedule.measure_with(&thread_cpu_now_s);
  for (int i = 0; i < ticks; ++i) {
    simulation_.tick();
    for (std::size_t s = 0; s < best.system_s.size(); ++s)
      best.system_s[s] = std::min(best.system_s[s], schedule.timings()[s].last_seconds);
  }
  schedule.measure_with(nullptr);
  turn_.now = nullptr;
  best.wall_s = std::ranges::min(series.wall);
  best.wall_median_s = median(series.wall);
  best.cpu_s = std::ranges::min(series.cpu);
  best.cpu_median_s = median(series.cpu);
  best.serial_share = median(series.serial_share);
}

}  // namespace mobil
