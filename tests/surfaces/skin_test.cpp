// People's skin: closed, with the survey's dimensions, with the body's mass, and intact in every pose.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/body/body_measures.h>
#include <mobil/assets/surfaces/body_form.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/place_skin.h>
#include "assets/surfaces/bone_surfaces.h"
#include "assets/surfaces/surface_mesh.h"
#include "tests/labels.h"
#include "tests/refused.h"
#include "tests/surfaces/skin_placed.h"

MOBIL_TEST_LABELS("threads;long");

namespace mobil::skin_test {
using namespace geometry;

constexpr std::array details = {SkinDetail::hero, SkinDetail::near, SkinDetail::far, SkinDetail::distant};

double volume(const BodySkin& skin, const std::vector<Vec3<float>>& position) {
  std::vector<Vec> place;
  for (const Vec3<float>& p : position) place.push_back(to_double(p));
  return enclosed_volume(skin_mesh(skin.sex, skin.detail).triangle, place);
}

BodyRequest sample_person(float height_m, float mass_kg, Sex sex = Sex::man) {
  BodyRequest body{.height_m = height_m, .mass_kg = mass_kg};
  body.sex = sex;
  return body;
}

BodyRequest elder(float height_m, float mass_kg, Sex sex) {
  BodyRequest body = sample_person(height_m, mass_kg, sex);
  body.age_y = 72;
  return body;
}

/// Two men and two women of usual build, a thin and a heavy person, an old man and an old woman; median people of 6 to
/// 60 years.
const std::array<BodyRequest, 18> people = {
    sample_person(1.75F, 75),     sample_person(1.90F, 84),     sample_person(1.65F, 62, Sex::woman),
    sample_person(1.75F, 58),     sample_person(1.75F, 105),    sample_person(1.60F, 85, Sex::woman),
    elder(1.73F, 82, Sex::man),   elder(1.60F, 68, Sex::woman), typical_body(Sex::man, 6),
    typical_body(Sex::woman, 6),  typical_body(Sex::man, 10),   typical_body(Sex::woman, 10),
    typical_body(Sex::man, 14),   typical_body(Sex::woman, 14), typical_body(Sex::man, 20),
    typical_body(Sex::woman, 20), typical_body(Sex::man, 60),   typical_body(Sex::woman, 60)};

/// Returns the undressed skin of one of `people` in the finest detail; made once.
const BodySkin& finest_skin(std::size_t person) {
  static std::array<std::optional<BodySkin>, people.size()> made;
  if (!made[person]) made[person] = *make_body_skin(*make_body(people[person]), SkinDetail::hero, {.dressed = false});
  return *made[person];
}

TEST(Skin, IsClosedAndBoundEverywhere) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const SkinDetail detail : details) {
      const SkinMesh& mesh = skin_mesh(sex, detail);
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge;
      for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t a = mesh.triangle[t + k], b = mesh.triangle[t + (k + 1) % 3];
          ASSERT_LT(a, mesh.vertex.size());
          ++edge[{a, b}];
        }
      }
      std::size_t open = 0, long_ones = 0;
      const double longest_m = detail == SkinDetail::near ? 0.044 : detail == SkinDetail::far ? 0.073 : 1;
      for (const auto& [ends, count] : edge) {
        long_ones += length(mesh.place[ends.second] - mesh.place[ends.first]) > longest_m ? 1 : 0;
        const auto other = edge.find({ends.second, ends.first});
        if (other == edge.end() || other->second != count) ++open;
      }
      EXPECT_EQ(open, 0U);
      EXPECT_LE(long_ones, edge.size() / 800);
      EXPECT_EQ(mesh.first_triangle[skin_parts], mesh.triangle.size() / 3);
      std::vector<std::uint32_t> without = mesh.triangle;
      drop_fins(without);
      EXPECT_EQ(without, mesh.triangle);
      EXPECT_TRUE(std::ranges::is_sorted(mesh.first_triangle));
      for (const SkinVertex& vertex : mesh.vertex) {
        float sum = 0;
        for (std::size_t k = 0; k < SkinVertex::max_frames; ++k) {
          sum += vertex.weight[k];
          ASSERT_LT(vertex.frame[k], mesh.frame.size());
        }
        ASSERT_NEAR(sum, 1, 1e-5F);
      }
    }
  }
}

TEST(SurfaceMesh, FinsAreDropped) {
  // A tetrahedron, and a triangle twice in the same sense. Fins: one at the tetrahedron, and two on the same vertices.
  const std::vector<std::uint32_t> kept = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 4, 5, 6, 4, 5, 6};
  const std::vector<std::array<std::uint32_t, 3>> fins = {{7, 1, 2}, {2, 1, 7}, {3, 7, 8},
                                                          {3, 8, 7}, {8, 3, 7}, {8, 7, 3}};
  for (std::size_t place = 0; place <= kept.size(); place += 3) {
    std::vector<std::uint32_t> mesh = kept;
    for (const auto& fin : fins) mesh.insert(mesh.begin() + static_cast<std::ptrdiff_t>(place), fin.begin(), fin.end());
    drop_fins(mesh);
    EXPECT_EQ(mesh, kept) << place;
  }
}

TEST(Skin, HasThePersonsMass) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    const BodyRequest& request = people[i];
    const Body body = *make_body(request);
    const BodySkin& skin = finest_skin(i);
    const double litres = 1e3 * volume(skin, skin.rest);
    // Without the air in the lungs (Quanjer 1993; less in the heavy), fat has 0.90 kg and all else 1.10 kg a litre
    // (Siri).
    const auto height_m = static_cast<double>(request.height_m), mass_kg = static_cast<double>(request.mass_kg),
               index = mass_kg / (height_m * height_m), fat_kg = static_cast<double>(body.composition.fat_kg),
               age_y = std::clamp(static_cast<double>(request.age_y), 18.0, 70.0);
    const auto litres_at = [&](double tall) {
      return request.sex == Sex::woman ? 2.24 * tall + 0.001 * age_y - 1 : 2.34 * tall + 0.01 * age_y - 1.09;
    };
    // Up to 14 years with the cube of height.
    const double air = (request.age_y <= 14 ? litres_at(1.75) * std::pow(height_m / 1.75, 3) : litres_at(height_m)) *
                       std::pow(0.9716, std::clamp(index, 24.0, 30.0) - 24);
    const double wanted = fat_kg / 0.90 + (mass_kg - fat_kg) / 1.10 + air;
    std::printf("[ skin ] %.2f m, %.0f kg, %.0f years: %.1f l, %+.1f %%\n", height_m, mass_kg,
                static_cast<double>(request.age_y), litres, 100 * (litres / wanted - 1));
    EXPECT_NEAR(litres / wanted, 1, 0.02);
  }
}

/// Returns true if an arm carries the vertex.
bool is_arms(const SkinMesh& mesh, std::uint32_t vertex) {
  return mesh.frame[mesh.vertex[vertex].frame[0]].to >= index(Segment::clavicle_right);
}

/// Returns the girth of trunk, neck or the legs between two x at the height y.
double tape(const BodySkin& skin, double y, double from_x, double to_x) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  std::vector<std::array<double, 2>> cut;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    if (is_arms(mesh, mesh.triangle[t])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec a = to_double(skin.rest[mesh.triangle[t + k]]),
                b = to_double(skin.rest[mesh.triangle[t + (k + 1) % 3]]);
      if ((a.y < y) == (b.y < y)) continue;
      const Vec p = a + ((y - a.y) / (b.y - a.y)) * (b - a);
      if (p.x > from_x && p.x < to_x) cut.push_back({p.x, p.z});
    }
  }
  // A tape spans hollows: the convex hull.
  std::ranges::sort(cut);
  double length_m = 0;
  for (const int sense : {1, -1}) {
    std::vector<std::array<double, 2>> hull;
    for (const auto& p : cut) {
      while (hull.size() > 1) {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        if (sense * ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) > 0) break;
        hull.pop_back();
      }
      hull.push_back(p);
    }
    for (std::size_t i = 1; i < hull.size(); ++i)
      length_m += std::hypot(hull[i][0] - hull[i - 1][0], hull[i][1] - hull[i - 1][1]);
  }
  return length_m;
}

TEST(Skin, HasTheGirthsOfTheSurvey) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    const BodyRequest& request = people[i];
    const Body body = *make_body(request);
    const BodySkin& skin = finest_skin(i);
    const BodyMeasures m = body_measures(request);
    const form::LegForm leg(body, m, false);
    const form::FormScale scale = form::form_scale(body);
    constexpr double far = 0.01;
    struct Girth {
      const char* name;
      double y, from_x, to_x, wanted, tolerance;
    };
    double hips = 0;
    for (double y = 0.84; y < 0.97; y += 0.01) hips = std::max(hips, tape(skin, scale.height(y), -1, 1));
    EXPECT_NEAR(hips / m.buttock_girth, 1, 0.025);
    double broad = 0;
    for (const Vec3<float>& p : skin.rest) {
      if (static_cast<double>(p.y) > scale.height(1.2)) broad = std::max(broad, 2 * std::abs(static_cast<double>(p.x)));
    }
    EXPECT_NEAR(broad / m.shoulder_breadth, 1, 0.03);
    const std::array<Girth, 6> girths = {{{"lower thigh", leg.y(0.86), -1, -far, m.lower_thigh_girth, 0.02},
                                          {"calf", leg.y(1.36), -1, -far, m.calf_girth, 0.02},
                                          {"ankle", leg.y(1.84), -1, -far, m.ankle_girth, 0.04},
                                          {"waist", scale.height(1.057), -1, 1, m.waist_girth, 0.02},
                                          {"neck", scale.height(1.515), -1, 1, m.neck_girth, 0.02},
                                          {"chest", scale.height(1.287), -1, 1, m.chest_girth, 0.02}}};
    for (const Girth& girth : girths) {
      const double got = tape(skin, girth.y, girth.from_x, girth.to_x);
      std::printf("[ girth ] %.2f m, %.0f kg, %s: %.0f mm, %+.1f %%\n", static_cast<double>(request.height_m),
                  static_cast<double>(request.mass_kg), girth.name, 1e3 * got, 100 * (got / girth.wanted - 1));
      EXPECT_NEAR(got / girth.wanted, 1, girth.tolerance) << girth.name;
    }
  }
}

TEST(Skin, KeepsItsRestShapeAndMovesRigidly) {
  const Body body = *make_body(people[2]);
  const BodySkin skin = *make_body_skin(body, SkinDetail::near);
  const Pose<float> standing = standing_pose(body);
  const Placed at_rest = place(skin, standing);
  Pose<float> moved = standing;
  const Quat<float> turn{0, std::sin(0.6F), 0, std::cos(0.6F)};
  const Vec3<float> shift{3, 0.5F, -2};
  for (std::size_t s = 0; s < segment_count; ++s) {
    moved.rotation[s] = product(turn, moved.rotation[s]);
    moved.position_m[s] = rotated(turn, moved.position_m[s]) + shift;
  }
  const Placed there = place(skin, moved);
  for (std::size_t v = 0; v < skin.rest.size(); ++v) {
    ASSERT_LT(length(at_rest.position[v] - skin.rest[v]), 2e-6F);
    ASSERT_LT(length(there.position[v] - (rotated(turn, skin.rest[v]) + shift)), 5e-6F);
    ASSERT_NEAR(length(at_rest.normal[v]), 1, 1e-5F);
  }
}

/// Returns the share of a surface's area that is turned against its normals.
double folded(const BodySkin& skin, const Placed& placed) {
  const SkinMesh& mesh = skin_mesh(skin.sex, skin.detail);
  double wrong = 0, all = 0;
  for (std::size_t t = 0; t < mesh.triangle.size(); t += 3) {
    const std::uint32_t* v = &mesh.triangle[t];
    const auto& p = placed.position;
    const Vec3<float> twice = cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
    const Vec3<float> n = placed.normal[v[0]] + placed.normal[v[1]] + placed.normal[v[2]];
    all += static_cast<double>(length(twice));
    if (dot(twice, n) < 0) wrong += static_cast<double>(length(twice));
  }
  return wrong / all;
}

TEST(Skin, KeepsItsVolumeAndDoesNotFold) {
  const Body body = *make_body(people[0]);
  const BodySkin& skin = finest_skin(0);
  const double at_rest = volume(skin, skin.rest);
  struct Bend {
    float knee_deg, hip_deg, elbow_deg;
    double change, folds;
  };
  constexpr std::array<Bend, 5> bends = {{{0, 0, 0, 1e-4, 0.003},
                                          {30, 20, 20, 0.01, 0.004},
                                          {60, 30, 40, 0.02, 0.006},
                                          {90, 90, 70, 0.04, 0.02},
                                          {110, 60, 90, 0.05, 0.02}}};
  for (const Bend& bend : bends) {
    constexpr float rad = 3.14159265F / 180;
    const Placed placed = place(skin, bent(body, bend.knee_deg * rad, bend.hip_deg * rad, bend.elbow_deg * rad));
    const double change = volume(skin, placed.position) / at_rest - 1, folds = folded(skin, placed);
    std::printf("[ bend ] knee %.0f, hip %.0f, elbow %.0f: volume %+.2f %%, folded %.2f %% of the area\n",
                static_cast<double>(bend.knee_deg), static_cast<double>(bend.hip_deg),
                static_cast<double>(bend.elbow_deg), 100 * change, 100 * folds);
    EXPECT_LT(std::abs(change), bend.change);
    EXPECT_LT(folds, bend.folds);
  }
}

TEST(Skin, ChangesItsVolumeLittleInAWalk) {
  Simulation simulation;
  const Entity person = *simulation.spawn({});
  const BodySkin skin = *make_body_skin(simulation.person(person)->body, SkinDetail::far);
  const double at_rest = volume(skin, skin.rest);
  double least = 1e9, most = 0;
  for (int tick = 0; tick < 120; ++tick) {
    simulation.tick();
    const double now = volume(skin, place(skin, *simulation.get<Pose>(person)).position);
    least = std::min(least, now);
    most = std::max(most, now);
  }
  std::printf("[ stride ] volume %+.2f to %+.2f %%\n", 100 * (least / at_rest - 1), 100 * (most / at_rest - 1));
  EXPECT_LT((most - least) / at_rest, 0.02);
  EXPECT_NEAR(least / at_rest, 1, 0.03);
}

TEST(Skin, IsMadeForEveryBody) {
  for (const Sex sex : {Sex::man, Sex::woman}) {
    for (const auto& [height_m, mass_kg] : {std::pair{1.2F, 30.0F}, std::pair{1.2F, 130.0F}, std::pair{1.5F, 200.0F},
                                            std::pair{2.2F, 60.0F}, std::pair{2.2F, 200.0F}}) {
      const Body body = *make_body(sample_person(height_m, mass_kg, sex));
      const BodySkin skin = *make_body_skin(body, SkinDetail::far);
      float widest = 0, highest = 0;
      for (const Vec3<float>& p : skin.rest) {
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        widest = std::max(widest, std::abs(p.x));
        highest = std::max(highest, p.y);
      }
      std::printf("[ range ] %.1f m, %.0f kg: %.1f l, %.2f m wide\n", static_cast<double>(height_m),
                  static_cast<double>(mass_kg), 1e3 * volume(skin, skin.rest), 2 * static_cast<double>(widest));
      EXPECT_NEAR(highest, height_m, 0.03F * height_m);
      EXPECT_LT(widest, 0.45F);
    }
  }
  BodyRequest long_legs = sample_person(1.75F, 75);
  long_legs.limbs.thigh_m = 0.5F;
  EXPECT_FALSE(make_body_skin(*make_body(long_legs), SkinDetail::far));
}

TEST(Skin, NanMusclesLiftNothing) {
  const Body body = *make_body(people[0]);
  const BodySkin skin = *make_body_skin(body, SkinDetail::distant);
  const float nan = std::nanf("");
  const std::vector<Vec3<float>> muscles = {{nan, nan, nan}, {0, nan, 0}};
  SkinCover cover;
  cover_muscles(skin, standing_pose(body), 1, Side::right, muscles, cover.lift_m[Side::right]);
  for (const float lift : cover.lift_m[Side::right]) EXPECT_NEAR(lift, 0, 1e-6F);
}

TEST(Skin, HidesTheBones) {
  for (const BodyRequest& request : {people[0], people[2]}) {
    const Body body = *make_body(request);
    const form::BodyForm form(body, fit_trunk(body));
    const Pose<float> standing = standing_pose(body);
    for (const BoneSurface& bone : make_bone_surfaces(body)) {
      double out = -1;
      for (const Vec3<float>& p : bone.mesh.position)
        out = std::max(out, form.rest_distance(to_double(p + standing.position_m[index(bone.segment)])));
      EXPECT_LT(out, 0.008) << bone.mesh.name;
    }
  }
}

TEST(SkinWriter, SameOnAnyThreadsAndRefusesInvalidRequests) {
  Simulation simulation;
  BodySkins skins;
  std::vector<Entity> walkers;
  std::vector<SkinRequest> requests;
  std::vector<std::vector<float>> buffer;
  for (int i = 0; i < 5; ++i) {
    SpawnRequest request;
    request.body = sample_person(1.6F + 0.07F * static_cast<float>(i), 60 + 8 * static_cast<float>(i));
    request.x_m = static_cast<float>(i);
    std::array<Entity, 1> one{};
    ASSERT_TRUE(simulation.spawn({&request, 1}, one));
    walkers.push_back(one[0]);
    const auto shape = skins.of(request.body, SkinDetail::distant);
    ASSERT_TRUE(shape);
    buffer.emplace_back(6 * shape->skin->rest.size(), -1.0F);
    requests.push_back({one[0], *shape});
  }
  for (int i = 0; i < 30; ++i) simulation.tick();
  const auto aim = [&](std::vector<std::vector<float>>& to) {
    for (std::size_t i = 0; i < requests.size(); ++i) {
      const auto bytes = std::as_writable_bytes(std::span(to[i]));
      requests[i].positions = {bytes, 24};
      requests[i].normals = {bytes.subspan(12), 24};
    }
  };
  auto other = buffer;
  aim(buffer);
  SkinWriter writer;
  ASSERT_TRUE(writer.write(simulation.world(), requests));
  aim(other);
  ASSERT_TRUE(writer.write(simulation.world(), requests, Threads(2).jobs()));
  EXPECT_EQ(buffer, other);

  auto short_one = requests;
  short_one[3].positions.bytes = short_one[3].positions.bytes.first(100);
  EXPECT_TRUE(is_refused(writer.write(simulation.world(), short_one), "request 3"));
  ASSERT_TRUE(simulation.despawn({walkers.data() + 1, 1}));
  const auto gone = writer.write(simulation.world(), requests);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().status, Status::stale_entity);
  EXPECT_FALSE(skins.of(sample_person(3, 75), SkinDetail::far));
}

TEST(BodyMeasures, MatchTheSurveysMeans) {
  // ANSUR II, means of 3348 men under 40 (1.756 m, 85.5 kg): girths of thigh, calf, waist, chest, mm.
  const BodyMeasures man = body_measures(sample_person(1.7562F, 85.52F));
  EXPECT_NEAR(1e3 * man.thigh_girth, 624, 8);
  EXPECT_NEAR(1e3 * man.calf_girth, 391, 5);
  EXPECT_NEAR(1e3 * man.waist_girth, 927, 15);
  EXPECT_NEAR(1e3 * man.chest_girth, 1050, 12);
  // Means of all 1986 women (1.6285 m, 67.76 kg): foot length and breadth, hand breadth.
  const BodyMeasures woman = body_measures(sample_person(1.6285F, 67.76F, Sex::woman));
  EXPECT_NEAR(1e3 * woman.foot_length, 246.3, 1.5);
  EXPECT_NEAR(1e3 * woman.foot_breadth, 92.7, 1);
  EXPECT_NEAR(1e3 * woman.hand_breadth, 78.2, 1);
  EXPECT_GT(woman.hip_breadth, body_measures(sample_person(1.6285F, 67.76F)).hip_breadth);
}

TEST(BodyMeasures, ChangeWithAge) {
  const auto at = [](Sex sex, float age_y, double BodyMeasures::*measure) {
    BodyRequest body = sample_person(1.65F, 65, sex);
    body.age_y = age_y;
    return body_measures(body).*measure;
  };
  using M = BodyMeasures;
  EXPECT_NEAR(at(Sex::man, 55, &M::waist_girth) / at(Sex::man, 25, &M::waist_girth), 1.0621, 1e-4);
  EXPECT_NEAR(at(Sex::woman, 55, &M::calf_girth) / at(Sex::woman, 25, &M::calf_girth), 0.967, 1e-4);
  EXPECT_EQ(at(Sex::man, 90, &M::thigh_girth), at(Sex::man, 65, &M::thigh_girth));
  EXPECT_NEAR(at(Sex::man, 16, &M::waist_girth) / at(Sex::man, 10, &M::waist_girth), 1 / 1.084, 1e-4);
  // UK 1990 medians: waists of boys, m; girths of heads relative to the adult's.
  EXPECT_NEAR(body_measures(typical_body(Sex::man, 6)).waist_girth, 0.524, 0.02);
  EXPECT_NEAR(body_measures(typical_body(Sex::man, 14)).waist_girth, 0.664, 0.035);
  EXPECT_NEAR(at(Sex::woman, 6, &M::head_length) / at(Sex::woman, 10, &M::head_length), 0.938 / 0.967, 1e-4);
}

TEST(Skin, BuildsHaveStepsOfAges) {
  for (const auto& [age_y, step_y] :
       {std::pair{6.0F, 6}, std::pair{7.5F, 8}, std::pair{16.5F, 16}, std::pair{17.0F, 25}, std::pair{25.0F, 25},
        std::pair{33.0F, 40}, std::pair{70.0F, 70}, std::pair{95.0F, 85}}) {
    for (const Sex sex : {Sex::man, Sex::woman}) {
      const BodyRequest body = typical_body(sex, age_y);
      const SkinBuild build = skin_build(body, 1.5F);
      EXPECT_EQ(build.age_y, step_y);
      EXPECT_TRUE(make_body(build.body)) << age_y;
      EXPECT_NEAR(build.body.mass_kg / (build.body.height_m * build.body.height_m),
                  body.mass_kg / (body.height_m * body.height_m), 0.76F);
    }
  }
}

/// For any number of steps that a build is divided into, all stay within the documented ends.
RC_GTEST_PROP(Skin, BuildsStayWithinTheirEnds, ()) {
  BodyRequest body{.height_m = static_cast<float>(*rc::gen::inRange(1200, 2201)) / 1000,
                   .mass_kg = static_cast<float>(*rc::gen::inRange(300, 2001)) / 10};
  const auto index_of = [](const BodyRequest& of) { return of.mass_kg / (of.height_m * of.height_m); };
  for (const float step : {1.5F, 3.0F}) {
    const SkinBuild build = skin_build(body, step);
    RC_ASSERT(index_of(build.body) >= 13.499F);
    RC_ASSERT(index_of(build.body) <= 64.501F);
    if (index_of(body) > 15 && index_of(body) < 60) RC_ASSERT(std::fabs(index_of(build.body) - index_of(body)) <= step);
  }
}

}  // namespace mobil::skin_test
