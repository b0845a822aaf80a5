// Muscles on moving bones: ends stay on them, flesh stays out of them, and the kneecap stays near the femur.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/bent_legs.h"
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/leg_bones.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"

MOBIL_TEST_LABELS("long");

namespace mobil::muscle_ends_test {
namespace {

using namespace geometry;

constexpr std::array<BodyRequest, 8> people() {
  std::array<BodyRequest, 8> all{};
  constexpr std::array<std::array<float, 2>, 8> sizes = {
      {{1.75F, 75}, {1.65F, 62}, {1.90F, 90}, {1.60F, 70}, {1.75F, 58}, {1.70F, 95}, {1.15F, 20.5F}, {1.56F, 58}}};
  for (std::size_t i = 0; i < all.size(); ++i) all[i].height_m = sizes[i][0], all[i].mass_kg = sizes[i][1];
  all[1].sex = all[3].sex = all[7].sex = Sex::woman;
  all[6].age_y = 6, all[7].age_y = 85;
  return all;
}

constexpr std::array<Segment, 5> bones_of_leg = {Segment::pelvis, Segment::thigh_right, Segment::patella_right,
                                                 Segment::shank_right, Segment::foot_right};

/// Distances from one body's right bones in any pose.
struct Posed {
  const LegBones& bones;
  const Pose<float>& rest;
  const Pose<float>& now;

  Vec at_rest(Segment bone, const Vec3<float>& p) const {
    const std::size_t i = index(bone);
    return to_double(rest.position_m[i]) +
           rotated(conjugate(to_double(now.rotation[i])), to_double(p) - to_double(now.position_m[i]));
  }
  double distance(Segment bone, const Vec3<float>& p) const { return bones.distance(bone, at_rest(bone, p)); }
  /// Returns the distance outside the bone's triangles. Ends are closed within the bone.
  double off(Segment bone, const Vec3<float>& p) const {
    const Vec at = at_rest(bone, p);
    const double sampled = bones.distance(bone, at);
    return sampled < 0.0005 ? std::max(0.0, sampled) : length(bones.nearest(bone, at) - at);
  }
};

struct Found {
  double end_m = 0, in_bone_m = 0;
  Segment bone{};
  LegBend bend{};
};

TEST(MuscleEnds, StayOnBonesAndFleshStaysOut) {
  const int poses = std::getenv("MOBIL_LONG") != nullptr ? 167 : 8;  // each
  constexpr double near_end_m = 0.015;
  std::mt19937 random(4);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  std::map<std::string, Found> found;
  for (const BodyRequest& request : people()) {
    Simulation simulation(sharing());
    const Entity one = *simulation.spawn_posed(request);
    LegMuscles choice;
    choice.muscles = muscle_members();
    choice.method = Method::none;
    ASSERT_TRUE(simulation.set_muscles(one, choice));
    const Body body = simulation.person(one)->body;
    SurfaceChoice drawn_choice{.bones = false};
    drawn_choice.simulated = muscle_members();
    drawn_choice.sides = {true, false};
    const DrawnSurfaces drawn = *draw_surfaces(body, drawn_choice);
    const BodySurfaces bound = *bind_surfaces(body, drawn, drawn_choice);
    ASSERT_EQ(bound.part.size(), drawn.muscles.size());
    std::vector<SurfaceMuscle> muscles;
    for (const BodySurfaces::Driver& driver : bound.driver)
      muscles.push_back({driver.muscle, {simulation.muscle(one, driver.muscle, Side::right), {}}});
    // vertices away from the ends
    std::vector<std::vector<bool>> is_free;
    for (const auto& muscle : drawn.muscles) {
      const MuscleSurface& s = muscle.surface;
      const auto& position = s.mesh.position;
      const auto held = [&](std::size_t v) {
        return (v < s.origin_held.size() && s.origin_held[v] == 1) ||
               (v < s.insertion_held.size() && s.insertion_held[v] == 1);
      };
      auto& free = is_free.emplace_back(position.size(), true);
      for (std::size_t h = 0; h < position.size(); ++h) {
        if (!held(h) && !s.mesh.name.starts_with("patellar")) continue;
        for (std::size_t v = 0; v < position.size(); ++v)
          free[v] = free[v] && length(position[v] - position[h]) > static_cast<float>(near_end_m);
      }
    }
    const LegBones bones(body);
    const Pose<float> rest = standing_pose(body);
    std::vector<Vec3<float>> vertex(bound.vertices);
    SurfaceWriter writer;
    for (int i = 0; i < poses; ++i) {
      const LegBend bend{within(-20, 90), within(0, 110), within(-40, 20)};
      ASSERT_EQ(simulation.set_pose(one, with_bent_legs(body, bend)), Status::ok);
      for (int tick = 0; tick < 2; ++tick) simulation.tick();
      SurfaceRequest wanted{one, muscles, &bound};
      wanted.positions.bytes = std::as_writable_bytes(std::span(vertex));
      ASSERT_TRUE(writer.write(simulation.world(), {&wanted, 1}));
      const Pose<float> pose = *simulation.get<Pose>(one);
      const Posed posed{bones, rest, pose};
      for (std::size_t m = 0; m < drawn.muscles.size(); ++m) {
        const MuscleSurface& s = drawn.muscles[m].surface;
        Found& own = found[s.mesh.name];
        for (std::size_t v = 0; v < s.mesh.position.size(); ++v) {
          const Vec3<float>& p = vertex[bound.part[m].first_vertex + v];
          if (v < s.origin_held.size() && s.origin_held[v] == 1)
            own.end_m = std::max(own.end_m, posed.off(s.origin, p));
          if (v < s.insertion_held.size() && s.insertion_held[v] == 1)
            own.end_m = std::max(own.end_m, posed.off(s.insertion, p));
          if (!is_free[m][v]) continue;
          for (const Segment bone : bones_of_leg) {
            const double in = -posed.distance(bone, p);
            if (in > own.in_bone_m) own.in_bone_m = in, own.bone = bone, own.bend = bend;
          }
        }
      }
    }
  }
  for (const auto& [name, own] : found) {
    std::printf("[ ends ] %-32s off its bones %.1f mm, in the %s %.1f mm at hip %.0f knee %.0f ankle %.0f\n",
                name.c_str(), 1e3 * own.end_m, std::string(segment_name[index(own.bone)]).c_str(), 1e3 * own.in_bone_m,
                static_cast<double>(own.bend.hip_flexion), static_cast<double>(own.bend.knee_flexion),
                static_cast<double>(own.bend.dorsiflexion));
    EXPECT_LE(own.end_m, 0.001) << name;
    EXPECT_LE(own.in_bone_m, 0.004) << name;
  }
}

TEST(MuscleEnds, KneecapStaysNearTheFemur) {
  for (const BodyRequest& request : people()) {
    const Body body = *make_body(request);
    const auto all = make_bone_surfaces(body);
    const LegBones bones(body);
    const Pose<float> rest = standing_pose(body);
    const double small = std::min(1.0, static_cast<double>(body.size.leg_scale_m) / 1.5);
    for (float knee = 0; knee <= 110; knee += 5) {
      const Pose<float> pose = with_bent_legs(body, {20, knee, 0});
      const Posed posed{bones, rest, pose};
      double gap = 1;
      const std::size_t patella = index(Segment::patella_right);
      for (const Vec3<float>& p : all[patella].mesh.position) {
        const Vec3<float> at = pose.position_m[patella] + rotated(pose.rotation[patella], p);
        gap = std::min(gap, posed.distance(Segment::thigh_right, at));
      }
      EXPECT_GE(gap, 0.003 * small) << request.height_m << " m, knee at " << knee;
      EXPECT_LE(gap, 0.007) << request.height_m << " m, knee at " << knee;
    }
  }
}

}  // namespace
}  // namespace mobil::muscle_ends_test
