// Muscles stay near their lines, compared with bellies drawn uniformly along the line, for every method and joint
// angles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "tests/labels.h"
#include "tests/simulation/leg_muscles.h"

MOBIL_TEST_LABELS("long");

namespace mobil::stray_test {
using namespace geometry;

constexpr BodyRequest somebody{.height_m = 1.75F, .mass_kg = 75};

/// Returns a pose with both legs bent equally, degrees.
Pose<float> bent(const Body& body, float hip, float knee, float ankle) {
  using enum Segment;
  Pose<float> pose = standing_pose(body);
  for (std::size_t s = 0; s < segment_count; ++s) {
    const std::size_t parent = index(segment_parent[s]);
    if (s == parent) continue;
    const auto is = [s](Segment r) {
      return s == index(on_side(r, Side::right)) || s == index(on_side(r, Side::left));
    };
    const float by = is(thigh_right)     ? -hip
                     : is(shank_right)   ? knee
                     : is(patella_right) ? 0.9F * knee
                     : is(foot_right)    ? -ankle
                                         : 0.0F;
    const float half = 0.5F * 0.0174532925F * by;
    pose.rotation[s] = product(pose.rotation[parent], {std::sin(half), 0, 0, std::cos(half)});
    pose.position_m[s] = pose.position_m[parent] + rotated(pose.rotation[parent], body.joint_offset_m[s]);
  }
  return pose;
}

/// Displayed vertices of people with one choice, by name of the piece.
struct Shown {
  Simulation simulation{sharing()};
  std::vector<Entity> people;
  BodySurfaces surfaces;

  explicit Shown(const LegMuscles& choice) {
    SurfaceChoice drawn;
    drawn.bones = false;
    drawn.simulated = choice.muscles;
    drawn.cells = choice.cells;
    drawn.detail = 0.3;
    drawn.clear_of_bones = false;  // which would move some vertices to the other side of a bone
    surfaces = *bind_surfaces(*make_body(somebody), drawn);
  }
  std::vector<Vec3<float>> vertices(Entity person) const {
    const Person subject = *simulation.person(person);
    std::vector<SurfaceMuscle> muscles;
    for (const PersonMuscle& own : subject.muscles) muscles.push_back({own.plan.muscle, own.entity});
    std::vector<Vec3<float>> out(surfaces.vertices);
    const SurfaceRequest one{.person = person,
                             .muscles = muscles,
                             .surfaces = &surfaces,
                             .positions = {std::as_writable_bytes(std::span(out))}};
    SurfaceWriter writer;
    const auto done = writer.write(simulation.world(), {&one, 1});
    EXPECT_TRUE(done) << done.error().message;
    return out;
  }
};

/// Keeps the largest distance of each piece's vertices from their positions by the line alone, mm.
using Farthest = std::map<std::string, double>;
void keep(const Shown& shown, Entity person, const Shown& lines, Entity same, Farthest& farthest) {
  const auto is = shown.vertices(person), should = lines.vertices(same);
  for (const SurfacePart& part : shown.surfaces.part) {
    double& most = farthest[part.name];
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v)
      most = std::max(most, 1000 * static_cast<double>(length(is[v] - should[v])));
  }
}

void expect_within(const Farthest& farthest, double max_mm, const std::string& what) {
  std::string worst;
  double most = 0;
  for (const auto& [name, mm] : farthest) {
    // The short belly of the tensor hangs on the long tract, which the line alone leaves straight.
    EXPECT_LT(mm, name.starts_with("tensor") ? std::max(max_mm, 45.0) : max_mm) << name << " " << what;
    if (mm > most) most = mm, worst = name;
  }
  std::printf("%s: %s is %.0f mm off, the others less\n", what.c_str(), worst.c_str(), most);
}

std::vector<LegMuscles> every_choice(Method method) {
  std::vector<LegMuscles> all;
  for (const MuscleSet& set : {usual_muscles(), muscle_members()})
    all.push_back({.muscles = set, .method = method, .modal = {.cells = {2, 2, 8}}});
  return all;
}

/// At the ends and in the middle of the joints' ranges, at rest: each angle of a joint with each angle of any other
/// joint. With MOBIL_LONG all triples of angles.
TEST(Stray, MusclesStayNearTheirLinesInAnyPose) {
  MOBIL_SLOW();
  const bool longer = std::getenv("MOBIL_LONG") != nullptr;
  constexpr std::array hips = {-20.0F, 45.0F, 115.0F}, knees = {0.0F, 65.0F, 130.0F}, ankles = {-40.0F, 0.0F, 20.0F};
  for (const Method method : {Method::statics, Method::explicit_central, Method::implicit_central, Method::newmark,
                              Method::modal, Method::finite}) {
    for (const LegMuscles& choice : every_choice(method)) {
      Shown shown(choice), lines({.muscles = choice.muscles, .method = Method::none});
      Farthest farthest;
      for (std::size_t i = 0; i < 27; ++i) {
        const std::size_t h = i / 9, k = i / 3 % 3, a = i % 3;
        if (!longer && (h + k + a) % 3 != 1) continue;
        const float hip = hips[h], knee = knees[k], ankle = ankles[a];
        std::array<Entity, 2> same;
        for (Shown* one : {&shown, &lines}) {
          const Entity person = *one->simulation.spawn_posed(somebody);
          ASSERT_TRUE(one->simulation.set_pose(person, bent(*make_body(somebody), hip, knee, ankle)));
          const auto added = one->simulation.set_muscles(
              person, one == &shown ? choice : LegMuscles{.muscles = choice.muscles, .method = Method::none});
          ASSERT_TRUE(added) << added.error().message;
          one->simulation.tick();
          same[one == &shown ? 0 : 1] = person;
        }
        keep(shown, same[0], lines, same[1], farthest);
        ASSERT_TRUE(shown.simulation.despawn(same[0]));
        ASSERT_TRUE(lines.simulation.despawn(same[1]));
      }
      const bool groups = choice.muscles == usual_muscles();
      expect_within(farthest, groups ? 25 : 30, name(method) + (groups ? " groups" : " members"));
    }
  }
}

/// In a walk, with vibration.
TEST(Stray, MusclesStayNearTheirLinesInAWalk) {
  for (const Method method : {Method::explicit_central, Method::modal, Method::finite}) {
    for (const LegMuscles& choice : every_choice(method)) {
      Shown shown(choice), lines({.muscles = choice.muscles, .method = Method::none});
      const Entity person = *shown.simulation.spawn(somebody, {.speed_m_s = 1.4F});
      const Entity same = *lines.simulation.spawn(somebody, {.speed_m_s = 1.4F});
      ASSERT_TRUE(shown.simulation.set_muscles(person, choice));
      ASSERT_TRUE(lines.simulation.set_muscles(same, {.muscles = choice.muscles, .method = Method::none}));
      Farthest farthest;
      for (int tick = 0; tick < 90; ++tick) {
        shown.simulation.tick();
        lines.simulation.tick();
        if (tick % 3 == 0) keep(shown, person, lines, same, farthest);
      }
      const bool groups = choice.muscles == usual_muscles();
      expect_within(farthest, 25, name(method) + (groups ? " groups" : " members") + " walking");
    }
  }
}

}  // namespace mobil::stray_test
