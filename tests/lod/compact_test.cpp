// Unseen people are compact, and full when seen again, with the gait and muscles of people who were never compact.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/components/lod.h>
#include <mobil/engine/world.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>
#include <mobil/systems/surfaces/nodal_view.h>
#include "demo/scene/crowd_people.h"
#include "systems/gait/gait.h"
#include "tests/interfaces.h"
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::lod_compact_test {
namespace {

/// People around a camera that turns.
struct Turning {
  explicit Turning(bool compact, int threads, std::size_t count, MuscleSet muscles) : simulation({.threads = threads}) {
    LodOptions options;
    options.machine_factor = 1;
    options.leg_muscles.muscles = muscles;
    lod.emplace(lod_of(simulation, options));
    needs.muscles = muscles;
    needs.compact_unseen = compact;
    needs.tolerance_px = 2;
    look();
    std::vector<SpawnRequest> requests;
    for (std::uint64_t number = 0; requests.size() < count; ++number) {
      const CrowdPerson person = crowd_person(9, number, 0);
      const auto body = make_body(person.body);
      if (!body || !resolve_gait(*body, person.gait)) continue;
      const CrowdPlace place = crowd_place(9, number);
      requests.push_back({.body = person.body,
                          .gait = person.gait,
                          .x_m = 12 * place.across,
                          .z_m = 12 * place.along,
                          .heading_rad = place.heading_rad});
    }
    people.resize(count);
    EXPECT_TRUE(simulation.spawn(requests, people));
    for (const Entity person : people) EXPECT_TRUE(lod->manage(person));
  }
  void look() {
    const float yaw = 0.5F * static_cast<float>(simulation.time_s());
    Viewpoint camera;
    camera.position_m = {0, 1.6F, 0};
    camera.forward = {std::sin(yaw), 0, std::cos(yaw)};
    camera.half_angle_rad = 0.5F;
    camera.radians_per_pixel = 0.001F;
    camera.near_m = 12;  // all people continue unseen
    camera.reach_m = 12;
    needs.camera = camera;
    ASSERT_TRUE(lod->set_scene(needs));
  }
  LodReport tick() {
    look();
    for (std::size_t i = 0; i < people.size() && simulation.ticks() % 90 == 40; i += 5) {
      EXPECT_TRUE(simulation.turn_to(people[i], 0.3F * static_cast<float>(i % 9)));
    }
    simulation.tick();
    const LodReport report = lod->report();
    EXPECT_EQ(report.refused, 0U) << report.refusal;
    return report;
  }
  View view(std::size_t i) const { return static_cast<View>(simulation.get<LodState>(people[i])->view); }

  Simulation simulation;
  std::optional<Lod> lod;
  LodScene needs;
  std::vector<Entity> people;
};

/// Returns the largest distance between the control points of two muscles, m, or nothing if they are not placed.
std::optional<double> apart(const Simulation& a, Entity one, const Simulation& b, Entity other) {
  const NodalView u = nodal_displacement(a.world(), one), v = nodal_displacement(b.world(), other);
  if (u.first == nullptr || v.first == nullptr) return std::nullopt;
  double worst = 0;
  for (std::size_t k = 0; k < 3 * std::size_t{u.nodes}; ++k)
    worst = std::max(worst, std::fabs(double{u.first[k * lane_count]} - double{v.first[k * lane_count]}));
  return worst;
}

TEST(LodCompact, UnseenPeopleAreCompactWithTheSameState) {
  MOBIL_SLOW();
  constexpr std::size_t count = 90;
  const MuscleSet muscles(5);
  Turning compact(true, 1, count, muscles), whole(false, 1, count, muscles);
  std::size_t shrank = 0, grew = 0, small = 0, compared = 0;
  double worst = 0;
  std::vector<std::array<int, 4>> alike(count);  // number of ticks with equal methods
  for (int t = 0; t < 900; ++t) {
    const LodReport report = compact.tick();
    whole.tick();
    shrank += report.compacted;
    grew += report.expanded;
    for (std::size_t i = 0; i < count; ++i) {
      const Entity a = compact.people[i], b = whole.people[i];
      const bool is_small = (compact.simulation.state(a) == PersonState::compact);
      if (is_small) {
        ++small;
        EXPECT_NE(compact.view(i), View::seen);
      }
      if (t % 20 == 19) {
        const auto pose = compact.simulation.get<Pose>(a), other = whole.simulation.get<Pose>(b);
        ASSERT_EQ(std::memcmp(&*pose, &*other, sizeof(*pose)), 0) << "person " << i << " tick " << t;
      }
      for (const std::size_t m : {std::size_t{0}, std::size_t{2}}) {
        const auto muscle = static_cast<Muscle>(m);
        MuscleMethod one = compact.simulation.method(a, muscle), two = whole.simulation.method(b, muscle);
        one.modal.control_points = two.modal.control_points;  // placed some ticks later after expansion
        alike[i][m] = same_method(one, two) ? alike[i][m] + 1 : 0;
        if (is_small || alike[i][m] < 120) continue;  // the vibration of a change has decayed
        const auto off = apart(compact.simulation, compact.simulation.muscle(a, muscle, Side::left), whole.simulation,
                               whole.simulation.muscle(b, muscle, Side::left));
        if (!off) continue;
        worst = std::max(worst, *off);
        ++compared;
      }
    }
  }
  EXPECT_GT(shrank, 200U);
  EXPECT_GT(grew, 150U);
  EXPECT_GT(small, 30000U);
  EXPECT_GT(compared, 3000U);
  EXPECT_LT(worst, 5e-5);
}

TEST(LodCompact, CompactPeopleHaveRequestsAndReasons) {
  Turning scene(true, 1, 40, 2);
  for (int t = 0; t < 150; ++t) scene.tick();
  const auto at =
      std::ranges::find_if(scene.people, [&](Entity e) { return (scene.simulation.state(e) == PersonState::compact); });
  ASSERT_NE(at, scene.people.end());
  const auto why = scene.lod->why(*at, Muscle::quadriceps);
  ASSERT_TRUE(why);
  EXPECT_EQ(why->method.method, Method::modal);
  EXPECT_EQ(why->reason, Reason::tolerance) << why->text;
  ASSERT_TRUE(scene.lod->manage(*at, {.looked_at = true}));
  for (int t = 0; t < 12; ++t) scene.tick();
  EXPECT_NE(scene.simulation.state(*at), PersonState::compact);
  EXPECT_NE(
      nodal_displacement(scene.simulation.world(), scene.simulation.muscle(*at, Muscle::quadriceps, Side::left)).first,
      nullptr);
  ASSERT_TRUE(scene.lod->manage(*at));
  ASSERT_TRUE(scene.lod->force(*at, Muscle::quadriceps, {Method::none, {}}));
  scene.needs.compact_unseen = false;
  for (int t = 0; t < 12; ++t) scene.tick();
  EXPECT_TRUE(std::ranges::none_of(scene.people,
                                   [&](Entity e) { return (scene.simulation.state(e) == PersonState::compact); }));
}

}  // namespace
}  // namespace mobil::lod_compact_test
