// Skin over moving muscles: no muscle comes through, in walks and in any pose of the joints' ranges.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "assets/body/bent_legs.h"
#include "tests/labels.h"
#include "tests/simulation/people.h"
#include "tests/surfaces/skin_placed.h"

MOBIL_TEST_LABELS("long");

namespace mobil::skin_cover_test {
namespace {

using namespace geometry;
using skin_test::place;
using skin_test::Placed;

struct Somebody {
  float height_m, mass_kg;
  Sex sex;
  float age_y = usual_age_y;

  BodyRequest body() const {
    BodyRequest request{.height_m = height_m, .mass_kg = mass_kg};
    request.sex = sex;
    request.age_y = age_y;
    return request;
  }
};
/// The thin man's muscles are as large as they would be under more fat.
constexpr std::array<Somebody, 12> people = {{{1.75F, 75, Sex::man},
                                              {1.65F, 62, Sex::woman},
                                              {1.90F, 90, Sex::man},
                                              {1.60F, 70, Sex::woman},
                                              {1.75F, 58, Sex::man},
                                              {1.70F, 95, Sex::man},
                                              {1.15F, 20.5F, Sex::man, 6},
                                              {1.38F, 33, Sex::woman, 10},
                                              {1.64F, 51, Sex::man, 14},
                                              {1.62F, 88, Sex::woman, 45},
                                              {1.73F, 78, Sex::man, 70},
                                              {1.56F, 58, Sex::woman, 85}}};

/// Candidate triangles of a closed surface for rays along x.
class Rays {
 public:
  Rays(const std::vector<Vec3<float>>& position, const std::vector<std::uint32_t>& triangle)
      : position_(position), triangle_(triangle) {
    for (std::uint32_t t = 0; t < triangle.size(); t += 3) {
      int low_y = 1 << 30, low_z = 1 << 30, high_y = -low_y, high_z = -low_z;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [y, z] = cell(position[triangle[t + k]]);
        low_y = std::min(low_y, y), high_y = std::max(high_y, y), low_z = std::min(low_z, z),
        high_z = std::max(high_z, z);
      }
      for (int y = low_y; y <= high_y; ++y) {
        for (int z = low_z; z <= high_z; ++z) bucket_[{y, z}].push_back(t);
      }
    }
  }
  bool inside(const Vec3<float>& p) const {
    const auto found = bucket_.find(cell(p));
    if (found == bucket_.end()) return false;
    int crossings = 0;
    for (const std::uint32_t t : found->second) {
      const Vec3<float> a = position_[triangle_[t]] - p, b = position_[triangle_[t + 1]] - p,
                        c = position_[triangle_[t + 2]] - p;
      const auto turn = [](const Vec3<float>& u, const Vec3<float>& v) { return u.y * v.z - u.z * v.y; };
      const float ab = turn(a, b), bc = turn(b, c), ca = turn(c, a), all = ab + bc + ca;
      if ((ab < 0) != (bc < 0) || (bc < 0) != (ca < 0) || all == 0) continue;
      if ((bc * a.x + ca * b.x + ab * c.x) / all > 0) crossings += all > 0 ? 1 : -1;
    }
    return crossings != 0;
  }

  /// Returns the distance of a point from the surface, m; at most 0.05.
  double distance(const Vec3<float>& p) const {
    constexpr double far = 0.05;
    double nearest = far;
    for (std::size_t t = 0; t < triangle_.size(); t += 3) {
      const Vec a = to_double(position_[triangle_[t]]) - to_double(p);
      if (dot(a, a) > 4 * far * far) continue;
      const Vec b = to_double(position_[triangle_[t + 1]]) - to_double(p),
                c = to_double(position_[triangle_[t + 2]]) - to_double(p);
      nearest = std::min(nearest, from_origin(a, b, c));
    }
    return nearest;
  }

 private:
  /// Returns the distance of the origin from a triangle: from its plane if it is above the triangle, else from the
  /// nearest edge.
  static double from_origin(const Vec& a, const Vec& b, const Vec& c) {
    const Vec n = cross(b - a, c - a);
    const double area = length(n);
    if (area > 0 && dot(cross(a, b), n) >= 0 && dot(cross(b, c), n) >= 0 && dot(cross(c, a), n) >= 0)
      return std::abs(dot(a, n)) / area;
    double nearest = 1;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      const Vec edge = q - p;
      const double along = std::clamp(-dot(p, edge) / std::max(dot(edge, edge), 1e-20), 0.0, 1.0);
      nearest = std::min(nearest, length(p + along * edge));
    }
    return nearest;
  }
  static std::pair<int, int> cell(const Vec3<float>& p) {
    return {static_cast<int>(std::floor(p.y * 50)), static_cast<int>(std::floor(p.z * 50))};
  }
  const std::vector<Vec3<float>>& position_;
  const std::vector<std::uint32_t>& triangle_;
  std::map<std::pair<int, int>, std::vector<std::uint32_t>> bucket_;
};

/// Vertices of one muscle outside the skin by more than 2 mm.
struct Beyond {
  std::size_t vertices = 0;
  double worst_m = 0;
};

/// Share of a person's muscles outside the skin.
struct Outside {
  std::size_t all = 0, without = 0, outside = 0, beyond = 0;  // vertices; without cover, with it, by more than 2 mm
  double worst_m = 0, max_lift_m = 0;
  std::map<std::string, Beyond> by_part;

  void print(const char* what, const Somebody& of) const {
    const auto part = [&](std::size_t n) { return 100.0 * static_cast<double>(n) / static_cast<double>(all); };
    std::printf(
        "[ cover ] %s %.2f m %.0f kg %.0f years: of muscle outside %.2f %% without cover, %.3f %% with, by more than 2 "
        "mm"
        " %.3f %%, worst %.1f mm; lifted by %.1f mm\n",
        what, static_cast<double>(of.height_m), static_cast<double>(of.mass_kg), static_cast<double>(of.age_y),
        part(without), part(outside), part(beyond), 1e3 * worst_m, 1e3 * max_lift_m);
    for (const auto& [name, own] : by_part)
      std::printf("[ cover ]   %-34s %zu vertices by more than 2 mm, worst %.1f mm\n", name.c_str(), own.vertices,
                  1e3 * own.worst_m);
  }
};

/// One person's drawn muscles and the skin over them.
class Watched {
 public:
  Watched(Simulation& simulation, Entity person, const MuscleSet& drawn, double detail)
      : simulation_(simulation),
        person_(person),
        body_(simulation.person(person)->body),
        bound_(*bind_surfaces(body_, {.bones = false, .simulated = drawn, .detail = detail})),
        skin_(*make_body_skin(body_, SkinDetail::near, {.dressed = false})),
        vertex_(bound_.vertices) {
    for (const BodySurfaces::Driver& driver : bound_.driver) {
      muscles_.push_back({driver.muscle,
                          {simulation.muscle(person, driver.muscle, Side::right),
                           simulation.muscle(person, driver.muscle, Side::left)}});
    }
  }
  const Body& body() const { return body_; }

  void look(Outside& found) {
    SurfaceRequest wanted{person_, muscles_, &bound_};
    wanted.positions.bytes = std::as_writable_bytes(std::span(vertex_));
    ASSERT_TRUE(writer_.write(simulation_.world(), {&wanted, 1}));
    const Pose<float> pose = *simulation_.get<Pose>(person_);
    SkinCover cover;
    for (const Side side : {Side::right, Side::left}) {
      std::vector<Vec3<float>> of_side;
      for (const SurfacePart& part : bound_.part) {
        if (part.side != side) continue;
        of_side.insert(of_side.end(), vertex_.begin() + part.first_vertex,
                       vertex_.begin() + part.first_vertex + part.vertices);
      }
      cover_muscles(skin_, pose, 1, side, of_side, cover.lift_m[side]);
      for (const float lift : cover.lift_m[side])
        found.max_lift_m = std::max(found.max_lift_m, static_cast<double>(lift));
    }
    const std::vector<std::uint32_t>& triangle = skin_mesh(skin_.sex, skin_.detail).triangle;
    const Placed bare = place(skin_, pose), covered = place(skin_, pose, &cover);
    const Rays without(bare.position, triangle), with(covered.position, triangle);
    for (const SurfacePart& part : bound_.part) {
      for (const Vec3<float>& p : std::span(vertex_).subspan(part.first_vertex, part.vertices)) {
        ++found.all;
        found.without += without.inside(p) ? 0 : 1;
        if (with.inside(p)) continue;
        ++found.outside;
        const double off = with.distance(p);
        found.worst_m = std::max(found.worst_m, off);
        if (off <= 0.002) continue;
        ++found.beyond;
        Beyond& own = found.by_part[part.name];
        ++own.vertices;
        own.worst_m = std::max(own.worst_m, off);
      }
    }
  }

 private:
  const Simulation& simulation_;
  Entity person_;
  Body body_;
  BodySurfaces bound_;
  BodySkin skin_;
  std::vector<Vec3<float>> vertex_;
  std::vector<SurfaceMuscle> muscles_;
  SurfaceWriter writer_;
};

bool is_long() {
  return std::getenv("MOBIL_LONG") != nullptr;
}

/// Muscles of both legs, and limits: distance outside the skin, its lift, and share of vertices more than 2 mm outside.
struct Covered {
  MuscleSet muscles;
  double max_m, max_lift_m, max_beyond = 0;

  void expect(const Outside& found) const {
    const auto all = static_cast<double>(found.all);
    EXPECT_LE(static_cast<double>(found.beyond), max_beyond * all);
    EXPECT_LT(static_cast<double>(found.outside), 2e-3 * all);
    EXPECT_LT(found.outside, found.without);
    EXPECT_LT(found.worst_m, max_m);
    EXPECT_LT(found.max_lift_m, max_lift_m);
  }
};

struct Stride {
  std::optional<float> speed_m_s = std::nullopt;
  Method method = Method::explicit_central;
  double detail = 0.5;
  int every = 6;  // ticks between looks
};

void walk(const Covered& covered, const Somebody& somebody, const Stride& stride) {
  Simulation simulation(sharing());
  const Entity one = *simulation.spawn(somebody.body(), {.speed_m_s = stride.speed_m_s});
  LegMuscles choice;
  choice.muscles = covered.muscles;
  choice.method = stride.method;
  ASSERT_TRUE(simulation.set_muscles(one, choice));
  Watched watched(simulation, one, covered.muscles, stride.detail);
  Outside found;
  for (int tick = 0; tick < 130; ++tick) {
    simulation.tick();
    if (tick >= 60 && tick % stride.every == 0) watched.look(found);
  }
  found.print("walk", somebody);
  covered.expect(found);
}

void pose(const Covered& covered, int poses) {
  std::mt19937 random(4);
  const auto within = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
  for (const Somebody& somebody : people) {
    Simulation simulation(sharing());
    const Entity one = *simulation.spawn_posed(somebody.body());
    LegMuscles choice;
    choice.muscles = covered.muscles;
    choice.method = Method::statics;
    ASSERT_TRUE(simulation.set_muscles(one, choice));
    Watched watched(simulation, one, covered.muscles, 0.2);
    Outside found;
    for (int i = 0; i < poses; ++i) {
      const float hip = within(-20, 90), knee = within(0, 110), ankle = within(-40, 20);
      ASSERT_EQ(simulation.set_pose(one, with_bent_legs(watched.body(), {hip, knee, ankle})), Status::ok);
      for (int tick = 0; tick < 2; ++tick) simulation.tick();
      watched.look(found);
    }
    found.print("poses", somebody);
    covered.expect(found);
  }
}

TEST(SkinCover, CoversTheMusclesThroughAStride) {
  for (const Somebody& somebody : people) walk({usual_muscles(), 0.0012, 0.045}, somebody, {});
}

TEST(SkinCover, CoversTheMusclesInAnyPose) {
  pose({usual_muscles(), 0.0025, 0.06, 2e-5}, is_long() ? 167 : 12);
}

/// Three speeds of each with MOBIL_LONG=1. Single muscles pull farther away from their bones than their groups do.
TEST(SkinCover, CoversAllMusclesThroughAStride) {
  const Covered all{muscle_members(), 0.002, 0.07};
  const std::span<const Somebody> walkers = std::span(people).subspan(is_long() ? 0 : 4, is_long() ? people.size() : 1);
  for (const Somebody& somebody : walkers) {
    walk(all, somebody, {1.3F, Method::statics, 0.2, 24});
    for (const float speed_m_s : {0.8F, 1.8F})
      if (is_long()) walk(all, somebody, {speed_m_s, Method::statics, 0.2, 24});
  }
}

/// Sartorius is in front of the crease of a hip bent by more than 60°, where skin has no room.
TEST(SkinCover, CoversAllMusclesInAnyPose) {
  pose({muscle_members(), 0.006, 0.09, 6e-4}, is_long() ? 167 : 1);
}

}  // namespace
}  // namespace mobil::skin_cover_test
