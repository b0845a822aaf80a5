// A game loop: frames of any length, people spawned in batches, the game's own threads and memory, and poses at the
// exact time of each frame, written as into an instance buffer.

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory_resource>
#include <random>
#include <thread>
#include <vector>

#include <mobil/engine/world.h>
#include <mobil/pose_writer.h>
#include <mobil/simulation.h>

namespace {

/// Returns the game's job system, here one thread for each half of the work.
mobil::Jobs two_threads() {
  mobil::Jobs jobs;
  jobs.threads = 2;
  jobs.parallel_for = [](void*, std::size_t count, mobil::Jobs::Body body, void* context) {
    std::jthread other([=] { body(context, 0, count / 2); });
    body(context, count / 2, count);
  };
  return jobs;
}

int failed(const mobil::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 2;
}

}  // namespace

int main() {
  std::pmr::unsynchronized_pool_resource memory;
  const mobil::Jobs jobs = two_threads();
  mobil::Simulation simulation({.jobs = jobs, .memory = &memory});
  mobil::PoseWriter writer(&memory);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(0, 1);
  std::vector<mobil::Entity> people;
  std::vector<std::byte> instances;
  const mobil::PoseLayout matrices{.form = mobil::PoseForm::matrix, .axes = mobil::PoseAxes::y_up_left_handed};
  float fastest_m_s = 0, before_m[3] = {};

  for (int frame = 0; frame < 600; ++frame) {
    const double frame_s = 0.004 + 0.03 * static_cast<double>(any(random));
    if (frame % 50 == 0 && people.size() < 200) {
      std::vector<mobil::SpawnRequest> requests(50);
      for (mobil::SpawnRequest& one : requests) {
        one.body.height_m = 1.55F + 0.4F * any(random);
        one.body.mass_kg = 24 * one.body.height_m * one.body.height_m;
        one.gait.speed_m_s = 0.8F + 0.9F * any(random);
        one.x_m = 40 * any(random);
      }
      people.resize(people.size() + requests.size());
      const auto made = std::span(people).last(requests.size());
      if (const auto done = simulation.spawn(requests, made); !done) return failed(done.error());
      instances.resize(people.size() * mobil::segment_count * 12 * sizeof(float));
    }
    if (frame % 20 == 0) {
      const mobil::Entity who = people[static_cast<std::size_t>(any(random) * static_cast<float>(people.size() - 1))];
      if (const auto done = simulation.turn_to(who, 6 * any(random) - 3); !done) return failed(done.error());
    }
    const mobil::Ticks ticks = simulation.advance(frame_s);
    const double ahead_s = ticks.alpha * simulation.tick_s();  // time since the last tick
    if (const auto done = writer.write(simulation.world(), people, ahead_s, matrices, {instances}, jobs); !done)
      return failed(done.error());

    const auto* pelvis = reinterpret_cast<const float*>(instances.data());  // of the first person, a 3x4 matrix
    const float now_m[3] = {pelvis[3], pelvis[7], pelvis[11]};
    const float way_m = std::hypot(now_m[0] - before_m[0], now_m[1] - before_m[1], now_m[2] - before_m[2]);
    if (frame > 0) fastest_m_s = std::max(fastest_m_s, way_m / static_cast<float>(frame_s));
    std::copy(now_m, now_m + 3, before_m);
  }
  std::printf("%zu people, %u ticks; maximum drawn speed of the first pelvis %.2f m/s\n", people.size(),
              simulation.ticks(), static_cast<double>(fastest_m_s));
  return fastest_m_s < 3 ? 0 : 1;
}
