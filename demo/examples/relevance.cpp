// A camera passes two thousand people, and a budget holds: each muscle gets the cheapest method that shows no more than
// a pixel's error, and no frame waits for what methods share. Usage: relevance [FILE of `mobil bake`]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <vector>

#include <mobil/relevance.h>
#include <mobil/simulation.h>

namespace {

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int failed(const mobil::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return 2;
}

}  // namespace

int main(int count, char** arguments) {
  mobil::Simulation simulation;
  mobil::Relevance relevance(simulation);
  mobil::SceneNeeds scene{.camera = mobil::Viewpoint{.half_angle_rad = 0.6F}, .tolerance_px = 1, .budget_s = 0.002};
  // A game ships the file; here, without it, what is needed at a few metres is made at first use.
  const double start_ms = now_ms();
  if (count > 1) {
    std::vector<char> bytes(std::filesystem::file_size(arguments[1]));
    std::ifstream(arguments[1], std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (const auto done = simulation.load_baked(std::as_bytes(std::span(bytes))); !done) return failed(done.error());
  }
  std::printf("loaded in %.0f ms\n", now_ms() - start_ms);

  std::vector<mobil::SpawnRequest> asked(count > 1 ? 2000 : 200);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const std::size_t row = i / 50;
    asked[i].x_m = 2 * static_cast<float>(i % 50) - 50;
    asked[i].z_m = 2 * static_cast<float>(row);
  }
  std::vector<mobil::Entity> people(asked.size());
  if (const auto done = simulation.spawn(asked, people); !done) return failed(done.error());
  if (const auto done = relevance.manage(people); !done) return failed(done.error());

  double worst_ms = 0;
  std::size_t switched = 0;
  for (int tick = 0; tick < 300; ++tick) {
    scene.camera->position_m = {50 * std::sin(0.004F * static_cast<float>(tick)), 1.7F, -10};
    if (const auto done = relevance.set_scene(scene); !done) return failed(done.error());
    const double before_ms = now_ms();
    const mobil::RelevanceReport report = relevance.update();
    worst_ms = std::max(worst_ms, now_ms() - before_ms);
    switched += report.switched;
    if (report.refused > 0) return failed({report.refusal});
    simulation.tick();
  }
  std::printf("%zu changes of method, the longest update %.2f ms; quadriceps of number 100: %s\n", switched, worst_ms,
              relevance.why(people[100], mobil::Muscle::quadriceps)->text.c_str());
  return switched > 0 ? 0 : 1;
}
