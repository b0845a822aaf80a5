// The skin of `mobil walk --skin --skin-anatomy`, read back and reassembled as a viewer does: bones and muscles are
// inside it at keys of the animation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "tests/files/export_fixture.h"
#include "tests/labels.h"
#include "tests/program/program.h"

MOBIL_TEST_LABELS("long");

namespace mobil::skin_inside_test {
using Eigen::Vector3d;
using export_fixture::Viewer;
using Corners = std::array<Vector3d, 3>;

/// A closed surface as columns of triangles along one direction. Independent of the exporter's boxes.
class Columns {
 public:
  Columns(const std::vector<Corners>& triangle, const Vector3d& direction) {
    turn_ = Eigen::Quaterniond::FromTwoVectors(direction, Vector3d::UnitZ()).toRotationMatrix();
    for (const Corners& corner : triangle) {
      const Corners turned = {turn_ * corner[0], turn_ * corner[1], turn_ * corner[2]};
      const Vector3d low = turned[0].cwiseMin(turned[1]).cwiseMin(turned[2]),
                     high = turned[0].cwiseMax(turned[1]).cwiseMax(turned[2]);
      for (int x = cell(low.x()); x <= cell(high.x()); ++x)
        for (int y = cell(low.y()); y <= cell(high.y()); ++y) column_[{x, y}].push_back(turned);
    }
  }
  /// Returns how many more surfaces a ray from the point leaves than it enters.
  int winding(const Vector3d& point) const {
    const Vector3d p = turn_ * point;
    const auto found = column_.find({cell(p.x()), cell(p.y())});
    int sum = 0;
    if (found == column_.end()) return sum;
    for (const auto& [a, b, c] : found->second) {
      const auto side = [&](const Vector3d& u, const Vector3d& v) {
        return (v.x() - u.x()) * (p.y() - u.y()) - (v.y() - u.y()) * (p.x() - u.x());
      };
      const double of_c = side(a, b), of_a = side(b, c), of_b = side(c, a), all = of_a + of_b + of_c;
      if ((of_a < 0 || of_b < 0 || of_c < 0) && (of_a > 0 || of_b > 0 || of_c > 0)) continue;
      if (all == 0 || (of_a * a.z() + of_b * b.z() + of_c * c.z()) / all <= p.z()) continue;
      sum += all > 0 ? 1 : -1;
    }
    return sum;
  }

 private:
  static int cell(double at) { return static_cast<int>(std::floor(at / 0.01)); }
  Eigen::Matrix3d turn_;
  std::map<std::pair<int, int>, std::vector<Corners>> column_;
};

double distance_to(const Vector3d& p, const Corners& corner) {
  const auto& [a, b, c] = corner;
  const Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (area > 0) {
    const double u = normal.dot((b - a).cross(p - a)) / area, v = normal.dot((p - a).cross(c - a)) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) return std::abs(normal.dot(p - a)) / std::sqrt(area);
  }
  double nearest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d &from = corner[i], along = corner[(i + 1) % 3] - from;
    const double t = along.squaredNorm() == 0 ? 0 : std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - from - t * along).norm());
  }
  return nearest;
}

/// Vertices outside a skin: those from which rays in three directions leave it as often as they enter it.
struct Outside {
  double muscles_m = 0, bones_m = 0;  // largest distance of one to the skin
  std::size_t vertices = 0, beyond_a_millimetre = 0;
};

Outside outside_the_skin(const Viewer& viewer, std::size_t key) {
  std::vector<Corners> skin;
  const std::size_t figure = viewer.node.at("figure");
  const auto& parts = viewer.mesh_of(figure).primitives;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto shown = viewer.blended(figure, key, part);
    const auto corner = viewer.indices(parts[part].indices);
    for (std::size_t i = 0; i < corner.size(); i += 3)
      skin.push_back({shown[corner[i]], shown[corner[i + 1]], shown[corner[i + 2]]});
  }
  const std::array<Columns, 3> rays = {Columns(skin, {1, 0.013, 0.021}), Columns(skin, {-0.9, 0.3, -0.05}),
                                       Columns(skin, {0.1, -1, 0.07})};
  Outside found;
  for (const auto& [name, n] : viewer.node) {
    if (viewer.model.nodes[n].mesh < 0 || n == figure) continue;
    double& worst_m = name == "bones" ? found.bones_m : found.muscles_m;
    for (const Vector3d& p : viewer.drawn(n, key)) {
      ++found.vertices;
      if (std::ranges::any_of(rays, [&](const Columns& ray) { return ray.winding(p) != 0; })) continue;
      double distance_m = std::numeric_limits<double>::max();
      for (const Corners& corner : skin) distance_m = std::min(distance_m, distance_to(p, corner));
      worst_m = std::max(worst_m, distance_m);
      found.beyond_a_millimetre += distance_m > 1e-3;
    }
  }
  return found;
}

/// Walks and reads the file.
Viewer walked(const std::string& options) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("walk --skin " + options + " --out out", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  return Viewer(folder.path / "out" / "walk.glb");
}

void expect_inside(const std::string& options) {
  const Viewer viewer = walked("--skin-anatomy " + options);
  Outside worst;
  for (const std::size_t key : {0U, 4U, 8U, 12U, 16U, 20U, 24U, 29U}) {
    const Outside now = outside_the_skin(viewer, key);
    EXPECT_GT(now.vertices, 50'000U);
    EXPECT_LT(now.muscles_m, 1e-3) << options << ", key " << key;
    EXPECT_LT(now.bones_m, 1e-3) << options << ", key " << key;
    EXPECT_EQ(now.beyond_a_millimetre, 0U) << options << ", key " << key;
    worst = {std::max(worst.muscles_m, now.muscles_m), std::max(worst.bones_m, now.bones_m), now.vertices, 0};
  }
  testing::Test::RecordProperty("muscles_mm", std::to_string(1e3 * worst.muscles_m));
  testing::Test::RecordProperty("bones_mm", std::to_string(1e3 * worst.bones_m));
}

TEST(SkinInside, NothingComesThroughAnAverageMan) {
  expect_inside("--seconds 1");
}

TEST(SkinInside, NothingComesThroughAHeavyWomanWithSingleMuscles) {
  expect_inside("--height 1.65 --mass 95 --sex woman --speed 1.2m/s --seconds 1 --muscles all");
}

TEST(SkinInside, NothingComesThroughAThinFastManWithMovingMuscles) {
  expect_inside("--height 1.80 --mass 62 --speed 2m/s --seconds 1 --method modal --activation phase --inertia");
}

TEST(SkinInside, SkinAloneHasNeitherAnatomyNorShapes) {
  const Viewer viewer = walked("--seconds 0.2");
  ASSERT_EQ(viewer.model.meshes.size(), 1U);
  EXPECT_EQ(viewer.model.meshes[0].name, "figure");
  for (const auto& part : viewer.model.meshes[0].primitives) EXPECT_TRUE(part.targets.empty());
  EXPECT_EQ(viewer.model.skins.size(), 1U);
}

TEST(SkinInside, CountFindsWhatComesThrough) {
  Viewer viewer = walked("--seconds 0.6 --skin-anatomy");
  // Without the skin's shapes the muscles behind a bent knee come through.
  for (auto& mesh : viewer.model.meshes)
    if (mesh.name == "figure")
      for (auto& part : mesh.primitives) part.targets.clear();
  double muscles_m = 0;
  for (const std::size_t key : {0U, 5U, 10U, 15U})
    muscles_m = std::max(muscles_m, outside_the_skin(viewer, key).muscles_m);
  EXPECT_GT(muscles_m, 2e-3);
}

}  // namespace mobil::skin_inside_test
