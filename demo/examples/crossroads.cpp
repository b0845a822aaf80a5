// Two streams of walkers cross, and a player, who is not a walker, moves straight through them. Walkers avoid each
// other, the player and the walls.
//
// Prints the distances walked and the smallest distance between people. Exits with 1 if people overlap or one is stuck.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <mobil/avoidance.h>
#include <mobil/simulation.h>
#include <mobil/systems/poses/roots.h>

namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr std::size_t a_stream = 24;
constexpr double radius_m = 0.18, overlap_m = 0.06;  // of trunks; people who come nearer rotate their shoulders

}  // namespace

int main() {
  mobil::Simulation simulation;
  mobil::Avoidance avoidance = simulation.avoidance();
  std::vector<mobil::SpawnRequest> requests;
  for (std::size_t i = 0; i < 2 * a_stream; ++i) {
    const bool along_x = i < a_stream;
    const float row = 1.1F * (static_cast<float>(i % 3) - 1), back = 4 + 1.3F * static_cast<float>(i % a_stream / 3);
    mobil::SpawnRequest one;
    one.body = {.height_m = 1.72F, .mass_kg = 70};
    one.gait.speed_m_s = 1.15F + 0.05F * static_cast<float>(i % 5);
    one.x_m = along_x ? -back : row;
    one.z_m = along_x ? row : -back;
    one.heading_rad = along_x ? 0.5F * pi : 0;  // 0 is toward +Z
    requests.push_back(one);
  }
  std::vector<mobil::Entity> people(requests.size());
  if (!simulation.spawn(requests, people)) return 2;
  if (!avoidance.manage(people)) return 2;  // their desired velocity is the requested speed and heading

  const mobil::Wall walls[] = {{{-20, 2.6F}, {-2.6F, 2.6F}}, {{-20, -2.6F}, {-2.6F, -2.6F}}};
  if (!avoidance.set_walls(walls)) return 2;

  std::vector<mobil::Root> roots(people.size());
  double nearest_m = 10;
  for (int tick = 0; tick < 60 * 25; ++tick) {
    const float along = -12 + 1.4F / 60 * static_cast<float>(tick);
    const mobil::Disc player = {{along, -along}, 0.25F, 1.4F, -1.4F};
    if (!avoidance.set_discs({&player, 1})) return 2;
    simulation.tick();
    if (!simulation.roots(people, roots)) return 2;
    for (std::size_t i = 0; i < roots.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        nearest_m = std::min(nearest_m, std::hypot(roots[i].x_m - roots[j].x_m, roots[i].z_m - roots[j].z_m));
  }
  double min_m = 1e9, mean_m = 0;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const bool along_x = i < a_stream;
    const double way = along_x ? roots[i].x_m - double{requests[i].x_m} : roots[i].z_m - double{requests[i].z_m};
    min_m = std::min(min_m, way);
    mean_m += way / static_cast<double>(roots.size());
  }
  std::printf("in 25 s: %.1f m on average, %.1f m at least; smallest distance %.2f m\n", mean_m, min_m, nearest_m);
  return nearest_m > 2 * radius_m - overlap_m && min_m > 5 ? 0 : 1;
}
