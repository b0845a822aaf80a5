// Contacts of single muscles with each other and with bones: less new overlap than without, and no change at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/geometry.h>
#include <mobil/engine/world.h>
#include <mobil/muscle_table.h>
#include <mobil/simulation.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include <mobil/systems/surfaces/surface_contacts.h>
#include "assets/body/bent_legs.h"

namespace mobil::surface_contacts_test {
using namespace geometry;

/// A posed right leg with the single muscles of the usual groups.
class PosedLeg {
 public:
  PosedLeg() {
    LegMuscles choice;
    choice.method = Method::statics;
    choice.muscles = muscles_of_groups(usual_muscles());
    person_ = *simulation_.spawn_posed({.height_m = 1.75F, .mass_kg = 75});
    EXPECT_TRUE(simulation_.set_muscles(person_, choice));
    const Person person = *simulation_.person(person_);
    body_ = person.body;
    bound = *bind_surfaces(body_, {.sides = {true, false}, .simulated = choice.muscles, .detail = 0.2});
    for (const PersonMuscle& own : person.muscles) muscles_.push_back({own.plan.muscle, own.entity});
    position.resize(bound.vertices);
    normal.resize(bound.vertices);
    simulation_.tick(2);
    draw();
  }
  void pose(float hip_deg, float knee_deg, float ankle_deg) {
    EXPECT_TRUE(simulation_.set_pose(person_, with_bent_legs(body_, {hip_deg, knee_deg, ankle_deg})));
    simulation_.tick(2);
    draw();
  }
  double volume_m3(const SurfacePart& part) const {
    double sum = 0;
    each_triangle(part, [&](const Vec& a, const Vec& b, const Vec& c) { sum += dot(a, cross(b, c)) / 6; });
    return sum;
  }
  /// Returns the depth of each muscle vertex in another muscle or a bone, m.
  std::vector<double> depths() const {
    std::vector<double> depth(bound.vertices, 0);
    for (const SurfacePart& other : bound.part) {
      Vec low{9, 9, 9}, high{-9, -9, -9};
      for (std::uint32_t v = other.first_vertex; v < other.first_vertex + other.vertices; ++v) {
        const Vec p = to_double(position[v]);
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
      }
      for (const SurfacePart& own : bound.part) {
        if (!own.driver || own.driver == other.driver) continue;
        for (std::uint32_t v = own.first_vertex; v < own.first_vertex + own.vertices; ++v) {
          const Vec p = to_double(position[v]);
          if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z) continue;
          if (is_inside(p, other)) depth[v] = std::max(depth[v], distance(p, other));
        }
      }
    }
    return depth;
  }

  BodySurfaces bound;
  std::vector<Vec3<float>> position, normal;

 private:
  void draw() {
    SurfaceRequest request{person_, muscles_, &bound};
    request.positions.bytes = std::as_writable_bytes(std::span(position));
    request.normals.bytes = std::as_writable_bytes(std::span(normal));
    ASSERT_TRUE(writer_.write(simulation_.world(), {&request, 1}));
  }
  template <class F>
  void each_triangle(const SurfacePart& part, const F& f) const {
    for (std::uint32_t i = part.first_index; i < part.first_index + part.indices; i += 3)
      f(to_double(position[bound.index[i]]), to_double(position[bound.index[i + 1]]),
        to_double(position[bound.index[i + 2]]));
  }
  /// Returns true if the point is inside a closed surface, by the solid angle.
  bool is_inside(const Vec& p, const SurfacePart& part) const {
    double angle = 0;
    each_triangle(part, [&](const Vec& at_a, const Vec& at_b, const Vec& at_c) {
      const Vec a = at_a - p, b = at_b - p, c = at_c - p;
      const double la = length(a), lb = length(b), lc = length(c);
      angle += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    });
    return angle > 6.28;
  }
  double distance(const Vec& p, const SurfacePart& part) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v)
      least = std::min(least, length(to_double(position[v]) - p));
    return least;
  }

  Simulation simulation_;
  Entity person_;
  Body body_;
  std::vector<SurfaceMuscle> muscles_;
  SurfaceWriter writer_;
};

/// Returns the p-quantile of muscle vertices' additional depth relative to rest, mm.
double new_mm(const PosedLeg& leg, const std::vector<double>& rest, double p) {
  const std::vector<double> now = leg.depths();
  std::vector<double> more;
  for (const SurfacePart& part : leg.bound.part) {
    if (!part.driver) continue;
    for (std::uint32_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v)
      more.push_back(1e3 * std::max(0.0, now[v] - rest[v]));
  }
  std::ranges::sort(more);
  return more[static_cast<std::size_t>(p * static_cast<double>(more.size() - 1))];
}

TEST(SurfaceContacts, SeparateMusclesAndKeepTheirVolume) {
  PosedLeg leg;
  const SurfaceContacts contacts = find_contacts(leg.bound, leg.position, leg.normal);
  ContactWork work;
  const std::vector<double> rest = leg.depths();
  struct Posed {
    float hip, knee, ankle;
    double p95_mm, p99_mm;  // at most
  };
  for (const Posed& posed : {Posed{20, 10, 0, 0.2, 5}, Posed{-10, 5, 5, 0.5, 4}, Posed{30, 60, -15, 0.5, 11},
                             Posed{0, 60, -10, 1.3, 15}, Posed{0, 90, 0, 5, 15}, Posed{60, 110, -10, 10, 20}}) {
    leg.pose(posed.hip, posed.knee, posed.ankle);
    const double before95 = new_mm(leg, rest, 0.95), before99 = new_mm(leg, rest, 0.99);
    std::vector<double> volume;
    for (const SurfacePart& part : leg.bound.part) volume.push_back(leg.volume_m3(part));
    keep_apart(contacts, leg.position, leg.normal, work);
    const double after95 = new_mm(leg, rest, 0.95), after99 = new_mm(leg, rest, 0.99);
    double lost = 0;
    for (std::size_t p = 0; p < leg.bound.part.size(); ++p) {
      if (!leg.bound.part[p].driver || volume[p] < 10e-6) continue;
      lost = std::max(lost, std::abs(leg.volume_m3(leg.bound.part[p]) / volume[p] - 1));
    }
    std::printf(
        "[ contact ] hip %.0f, knee %.0f: new overlap of 95, 99 %% %.1f, %.1f mm (%.1f, %.1f without); volume"
        " within %.1f %%\n",
        static_cast<double>(posed.hip), static_cast<double>(posed.knee), after95, after99, before95, before99,
        100 * lost);
    EXPECT_LT(after95, posed.p95_mm);
    EXPECT_LT(after99, posed.p99_mm);
    EXPECT_LT(after99, before99);
    EXPECT_LT(lost, 0.003);
  }
}

TEST(SurfaceContacts, ChangeNothingAtRest) {
  PosedLeg leg;
  const SurfaceContacts contacts = find_contacts(leg.bound, leg.position, leg.normal);
  EXPECT_GT(contacts.pair.size(), 1000U);
  const auto before = leg.position;
  ContactWork work;
  keep_apart(contacts, leg.position, leg.normal, work);
  double most = 0;
  for (std::size_t v = 0; v < before.size(); ++v)
    most = std::max(most, static_cast<double>(length(leg.position[v] - before[v])));
  EXPECT_LT(most, 1e-4);
}

/// The result is equal at another place and rotation. Bones stay, and so do the muscles' ends.
TEST(SurfaceContacts, AreIndependentOfPlaceAndLeaveBones) {
  PosedLeg leg;
  const SurfaceContacts contacts = find_contacts(leg.bound, leg.position, leg.normal);
  ContactWork work;
  leg.pose(20, 40, 0);
  const auto drawn = leg.position;
  const Quat<float> turn{0, std::sin(0.4F), 0, std::cos(0.4F)};
  const Vec3<float> shift{3, 0, -2};
  std::vector<Vec3<float>> position, normal;
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    position.push_back(rotated(turn, leg.position[v]) + shift);
    normal.push_back(rotated(turn, leg.normal[v]));
  }
  keep_apart(contacts, leg.position, leg.normal, work);
  keep_apart(contacts, position, normal, work);
  double most = 0, moved = 0, bones = 0;
  for (std::size_t v = 0; v < drawn.size(); ++v) {
    const double off = length(to_double(rotated(turn, leg.position[v]) + shift) - to_double(position[v]));
    const double by = length(to_double(leg.position[v]) - to_double(drawn[v]));
    most = std::max(most, off);
    (contacts.band[v] == SurfaceContacts::no_band ? bones : moved) =
        std::max(contacts.band[v] == SurfaceContacts::no_band ? bones : moved, by);
    EXPECT_NEAR(length(leg.normal[v]), 1, 1e-3F);
  }
  EXPECT_LT(most, 1e-3);
  EXPECT_GT(moved, 0.002);
  EXPECT_LT(moved, 0.05);
  EXPECT_EQ(bones, 0);
}

}  // namespace mobil::surface_contacts_test
