// Muscles drawn at rest: they neither overlap nor extend outside the leg's skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/body/leg_profile.h>
#include <mobil/assets/muscles/leg_sections.h>
#include <mobil/assets/surfaces/muscle_surfaces.h>
#include <mobil/engine/geometry.h>

namespace mobil::muscle_rest_test {
namespace {

using namespace geometry;

struct Person {
  float height_m, mass_kg;
  Sex sex;
  Constitution constitution = Constitution::average;
};
constexpr std::array<Person, 6> people = {{{1.80F, 95, Sex::man, Constitution::athletic},
                                           {1.75F, 75, Sex::man},
                                           {1.65F, 62, Sex::woman},
                                           {1.75F, 58, Sex::man},
                                           {1.90F, 90, Sex::man},
                                           {1.60F, 85, Sex::woman}}};

Body body_of(const Person& person) {
  BodyRequest request{.height_m = person.height_m, .mass_kg = person.mass_kg};
  request.sex = person.sex;
  request.constitution = person.constitution;
  return *make_body(request);
}

/// The intersection of a horizontal plane with a closed mesh: pairs of points (x, z).
using Cut = std::vector<std::array<std::pair<double, double>, 2>>;
Cut cut_at(const SurfaceMesh& mesh, double y) {
  Cut cut;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    std::vector<std::pair<double, double>> ends;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec a = to_double(mesh.position[mesh.triangle[t + k]]),
                b = to_double(mesh.position[mesh.triangle[t + (k + 1) % 3]]);
      if ((a.y < y) == (b.y < y)) continue;
      const double u = (y - a.y) / (b.y - a.y);
      ends.emplace_back(a.x + u * (b.x - a.x), a.z + u * (b.z - a.z));
    }
    if (ends.size() == 2) cut.push_back({ends[0], ends[1]});
  }
  return cut;
}
bool is_within(const Cut& cut, double x, double z) {
  bool within = false;
  for (const auto& [a, b] : cut) {
    if ((a.second < z) == (b.second < z)) continue;
    const double u = (z - a.second) / (b.second - a.second);
    if (a.first + u * (b.first - a.first) > x) within = !within;
  }
  return within;
}

TEST(MusclesAtRest, DoNotOverlap) {
  for (const Person& person : people) {
    const Body body = body_of(person);
    const std::vector<GroupSurface> muscles = make_muscle_surfaces(body);
    const LegFrame leg = leg_frame(body);
    constexpr double step_m = 0.002;
    double once = 0, twice = 0;  // points in one muscle, and in several
    for (double level = 0.12; level < 1.9; level += 0.05) {
      std::vector<Cut> cuts;
      for (const GroupSurface& muscle : muscles)
        cuts.push_back(cut_at(muscle.surface.mesh, leg_point(leg, level, 0, 0).y));
      for (double x = leg.hip.x - 0.12; x < leg.hip.x + 0.12; x += step_m) {
        for (double z = -0.12; z < 0.12; z += step_m) {
          const auto in = std::ranges::count_if(cuts, [&](const Cut& cut) { return is_within(cut, x, z); });
          once += in > 0 ? 1 : 0;
          twice += in > 1 ? 1 : 0;
        }
      }
    }
    std::printf("[ rest ] %.2f m %.0f kg: %.2f %% of the muscles' sections lie in another's\n",
                static_cast<double>(person.height_m), static_cast<double>(person.mass_kg), 100 * twice / once);
    EXPECT_LT(twice, 0.023 * once);
  }
}

TEST(MusclesAtRest, AreWithinTheSkin) {
  for (const Person& person : people) {
    const Body body = body_of(person);
    const LegFrame leg = leg_frame(body);
    const bool strong = person.constitution == Constitution::athletic;  // the skin yields
    const LegProfile skin(body_measures(body.request));
    double farthest_m = -1;
    for (const GroupSurface& muscle : make_muscle_surfaces(body)) {
      for (const Vec3<float>& p : muscle.surface.mesh.position) {
        const double level = leg_level(leg, static_cast<double>(p.y));
        if (level < 0.15 || level > LegProfile::last_s) continue;
        const double x = leg.hip.x - static_cast<double>(p.x), z = static_cast<double>(p.z) - leg.hip.z;
        const double turn = std::atan2(-x, z);
        const double room = skin.radius(level, turn < 0 ? turn + 2 * std::numbers::pi : turn);
        farthest_m = std::max(farthest_m, std::hypot(x, z) - room);
      }
    }
    std::printf("[ rest ] %.2f m %.0f kg: muscles reach to %.1f mm beneath the skin\n",
                static_cast<double>(person.height_m), static_cast<double>(person.mass_kg), -1e3 * farthest_m);
    EXPECT_LT(farthest_m, strong ? 0.012 : 0.006);  // thin people's knee tendons, next to the bone
  }
}

}  // namespace
}  // namespace mobil::muscle_rest_test
