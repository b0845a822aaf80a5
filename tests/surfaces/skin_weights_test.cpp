// Linear blend skinning with skin_weights stays near the library's own skin.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/engine/geometry.h>
#include <mobil/simulation.h>
#include <mobil/skin_weights.h>
#include <mobil/skin_writer.h>
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::skin_weights_test {
namespace {
using namespace geometry;

/// Returns a vertex by linear blend skinning.
Vec blended(const SkinWeights& skin, const Pose<float>& pose, std::size_t v) {
  Vec at{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t joint = skin.joints[v].joint[k];
    const Vec from_joint = to_double(skin.position[v]) - to_double(skin.joint_m[joint]);
    const Vec moved = to_double(pose.position_m[joint]) + rotated(to_double(pose.rotation[joint]), from_joint);
    at = at + static_cast<double>(skin.joints[v].weight[k]) * moved;
  }
  return at;
}

/// Returns the distance of a point from a triangle's plane within the triangle, or from its corners and edges.
double distance(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
  const auto to_edge = [&](const Vec& from, const Vec& to) {
    const Vec along = to - from;
    const double t = std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
    return length(p - from - t * along);
  };
  const Vec normal = cross(b - a, c - a);
  const bool inside = dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
                      dot(cross(a - c, p - c), normal) >= 0;
  if (inside) return std::abs(dot(p - a, normal)) / length(normal);
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

/// A forearm's skin slides round it: no segment has a part of the hand's turn.
bool slides(const JointWeights& joints) {
  const auto s = static_cast<Segment>(joints.joint[0]);
  using enum Segment;
  return s == forearm_right || s == forearm_left || s == upper_arm_right || s == upper_arm_left;
}

struct Walker {
  BodyRequest body;
  float speed_m_s;
  SkinDetail detail;
};

/// Distances of all vertices over a stride from their place, of arms' vertices from the skin, m, in order.
std::vector<double> distances(const Walker& of) {
  Simulation simulation;
  const Entity person = *simulation.spawn(of.body, {.speed_m_s = of.speed_m_s});
  BodySkins skins;
  const SkinShape shape = *skins.of(of.body, of.detail);
  const SkinWeights skin = skin_weights(*shape.skin, shape.lengths);
  std::vector<Vec3<float>> own(shape.skin->rest.size());
  const SkinRequest request{person, shape, {std::as_writable_bytes(std::span(own)), 12}};
  SkinWriter writer;
  std::vector<double> away;
  for (int instant = 0; instant < 12; ++instant) {
    simulation.tick(6);
    EXPECT_TRUE(writer.write(simulation.world(), {&request, 1}));
    const Pose<float> pose = *simulation.get<Pose>(person);
    for (std::size_t v = 0; v < skin.vertex.size(); v += slides(skin.joints[v]) ? 7 : 1) {
      const Vec at = blended(skin, pose, v);
      double least = length(at - to_double(own[skin.vertex[v]]));
      const auto corner = [&](std::size_t i) { return to_double(own[skin.vertex[skin.triangle[i]]]); };
      for (std::size_t i = 0; least > 0.001 && slides(skin.joints[v]) && i < skin.triangle.size(); i += 3) {
        const Vec a = corner(i);
        if (length(at - a) < least + 0.08) least = std::min(least, distance(at, a, corner(i + 1), corner(i + 2)));
      }
      away.push_back(least);
    }
  }
  std::ranges::sort(away);
  return away;
}

TEST(SkinWeights, AreWithin25MillimetresOfTheLibrarysSkin) {
  const Walker walkers[] = {{{.height_m = 1.80F, .mass_kg = 80}, 1.39F, SkinDetail::near},
                            {{.height_m = 1.62F, .mass_kg = 58, .sex = Sex::woman}, 0.8F, SkinDetail::far},
                            {{.height_m = 1.70F, .mass_kg = 105}, 1.2F, SkinDetail::distant},
                            {{.height_m = 1.90F, .mass_kg = 68}, 2.0F, SkinDetail::far}};
  for (const Walker& walker : walkers) {
    const std::vector<double> away = distances(walker);
    EXPECT_LT(away[away.size() / 2], 0.001) << walker.body.height_m;
    EXPECT_LT(away.back(), walker.body.mass_kg < 90 ? 0.020 : 0.025) << walker.body.height_m;
  }
}

TEST(SkinWeights, AddUpToOneAndAreSorted) {
  BodySkins skins;
  for (const Sex sex : {Sex::man, Sex::woman}) {
    const SkinShape shape = *skins.of({.height_m = 1.7F, .mass_kg = 66, .sex = sex}, SkinDetail::distant);
    const SkinWeights skin = skin_weights(*shape.skin, shape.lengths);
    ASSERT_EQ(skin.joints.size(), skin.position.size());
    for (const JointWeights& joints : skin.joints) {
      float sum = 0;
      for (const float w : joints.weight) sum += w;
      EXPECT_NEAR(sum, 1, 1e-6);
      EXPECT_TRUE(std::ranges::is_sorted(joints.weight, std::greater<>()));
      EXPECT_GE(joints.weight[3], 0);
    }
    EXPECT_EQ(skin.triangle.size(), 3 * skin.first_triangle.back());
    EXPECT_LT(*std::ranges::max_element(skin.triangle), skin.position.size());
  }
}

}  // namespace
}  // namespace mobil::skin_weights_test
