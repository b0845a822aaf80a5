// Polygons of faces: their triangles have the polygon's area and edges, and none lies outside.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <mobil/mesh_file.h>
#include "assets/import/polygon_cut.h"
#include "assets/surfaces/surface_mesh.h"
#include "engine/eigen.h"
#include "tests/refused.h"

namespace mobil::polygon_cut_test {
using Eigen::Vector2d;
using Eigen::Vector3d;

using Polygon = std::vector<Vector2d>;

double area_of(const Polygon& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector2d &a = p[i], &b = p[(i + 1) % p.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

struct Cut {
  PolygonCut cut = PolygonCut::whole;
  std::vector<std::uint32_t> triangle;
  double least = 1e9, sum = 0;  // areas of the triangles along the polygon's normal
};

/// Cuts the polygon as it stands in a plane of space.
Cut cut_in_space(const Polygon& polygon, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity(),
                 const std::vector<double>& height = {}) {
  std::vector<Vec3<float>> position;
  std::vector<std::uint32_t> corner(polygon.size());
  std::iota(corner.begin(), corner.end(), 0U);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d p = turn * Vector3d(polygon[i].x(), polygon[i].y(), height.empty() ? 0 : height[i]);
    position.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  Cut made;
  made.triangle.resize(3 * (polygon.size() - 2));
  std::size_t work = 100'000'000;
  made.cut = cut_polygon(position, corner, made.triangle.data(), work);
  for (std::size_t t = 0; t < made.triangle.size(); t += 3) {
    const double area =
        area_of({polygon[made.triangle[t]], polygon[made.triangle[t + 1]], polygon[made.triangle[t + 2]]});
    made.least = std::min(made.least, area);
    made.sum += area;
  }
  return made;
}

/// True if each edge of the polygon is in one triangle, and each other edge in two, once in either direction.
bool has_edges_of(const Cut& cut, std::size_t corners) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edge;
  for (std::size_t t = 0; t < cut.triangle.size(); t += 3) {
    for (std::size_t c = 0; c < 3; ++c) ++edge[{cut.triangle[t + c], cut.triangle[t + (c + 1) % 3]}];
  }
  for (const auto& [ends, count] : edge) {
    const bool border = ends.second == (ends.first + 1) % corners;
    if (count != 1 || edge.contains({ends.second, ends.first}) == border) return false;
  }
  return edge.size() == 3 * corners - 6;
}

/// A star of random radii about the origin, wound to the left; corners on its edges are collinear.
Polygon random_star(bool with_collinear) {
  const int corners = *rc::gen::inRange(4, 40);
  Polygon star;
  for (int i = 0; i < corners; ++i) {
    const double radius = *rc::gen::inRange(1, 100), angle = 2 * M_PI * i / corners;
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  if (!with_collinear) return star;
  Polygon finer;
  for (std::size_t i = 0; i < star.size(); ++i) {
    finer.push_back(star[i]);
    if (*rc::gen::arbitrary<bool>()) finer.push_back((star[i] + star[(i + 1) % star.size()]) / 2);
  }
  return finer;
}

Eigen::Matrix3d random_turn() {
  const auto number = [] { return *rc::gen::inRange(-100, 101) / 100.0; };
  Eigen::Quaterniond turn(number() + 1.5, number(), number(), number());
  return turn.normalized().toRotationMatrix();
}

RC_GTEST_PROP(PolygonCut, TrianglesOfAConcavePolygonHaveItsAreaAndEdges, ()) {
  const Polygon star = random_star(*rc::gen::arbitrary<bool>());
  const Cut cut = cut_in_space(star, random_turn());
  RC_ASSERT(cut.cut == PolygonCut::whole);
  RC_ASSERT(cut.least > -1e-3);  // corners in single precision
  RC_ASSERT(std::abs(cut.sum - area_of(star)) < 1e-6 * area_of(star));
  RC_ASSERT(has_edges_of(cut, star.size()));
}

RC_GTEST_PROP(PolygonCut, BentPolygonIsCutAsSeenAlongItsNormal, ()) {
  const Polygon star = random_star(false);
  std::vector<double> height;
  for (std::size_t i = 0; i < star.size(); ++i) height.push_back(*rc::gen::inRange(-100, 101) / 2000.0);
  const Cut cut = cut_in_space(star, random_turn(), height);
  RC_ASSERT(cut.cut == PolygonCut::whole);
  RC_ASSERT(cut.least > -0.5);
  RC_ASSERT(has_edges_of(cut, star.size()));
}

/// A comb of teeth. A fan covers only the first.
Polygon comb(int teeth) {
  Polygon polygon = {{2.0 * teeth, 0}, {2.0 * teeth, 1}};
  for (int t = teeth; t-- > 0;) {
    polygon.emplace_back(2 * t + 1.5, 10);
    polygon.emplace_back(2 * t + 1, 10);
    polygon.emplace_back(2 * t + 0.5, 1);
    polygon.emplace_back(2 * t, 1);
  }
  polygon.emplace_back(0, 0);
  return polygon;
}

TEST(PolygonCut, CombsSpiralsAndBridgesAreCovered) {
  Polygon spiral;
  for (int i = 0; i < 60; ++i) spiral.emplace_back((2 + 0.2 * i) * Vector2d(std::cos(0.3 * i), std::sin(0.3 * i)));
  for (int i = 60; i-- > 0;) spiral.emplace_back((2.5 + 0.2 * i) * Vector2d(std::cos(0.3 * i), std::sin(0.3 * i)));
  std::reverse(spiral.begin(), spiral.end());
  // A square with a square hole, joined to it by an edge that is passed twice.
  const Polygon hole = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  const Polygon two_holes = {{0, 0}, {9, 0}, {9, 4}, {6, 3}, {8, 3}, {8, 1}, {6, 1}, {6, 3},
                             {9, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
  const Polygon touching = {{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}};
  const Polygon doubled = {{0, 0}, {4, 0}, {4, 0}, {4, 4}, {2, 1}, {2, 1}, {2, 1}, {0, 4}};
  const Polygon spike = {{0, 0}, {4, 0}, {4, 2}, {6, 2}, {4, 2}, {4, 4}, {0, 4}};
  for (const Polygon& polygon : {comb(1), comb(7), comb(300), spiral, hole, two_holes, touching, doubled, spike}) {
    ASSERT_GT(area_of(polygon), 0);
    for (std::size_t first = 0; first < std::min<std::size_t>(polygon.size(), 20); ++first) {
      Polygon turned = polygon;
      std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
      const Cut cut = cut_in_space(turned);
      EXPECT_EQ(cut.cut, PolygonCut::whole) << polygon.size() << " corners from " << first;
      EXPECT_GE(cut.least, -1e-5) << polygon.size() << " corners from " << first;
      EXPECT_NEAR(cut.sum, area_of(polygon), 1e-5 * area_of(polygon));
    }
  }
}

TEST(PolygonCut, CrossedAndEmptyPolygonsAreFans) {
  EXPECT_EQ(cut_in_space({{0, 0}, {4, 4}, {4, 0}, {0, 4}}).cut, PolygonCut::crossed);
  EXPECT_EQ(cut_in_space({{0, 0}, {4, 0}, {1, 3}, {3, 3}, {0, 1}}).cut, PolygonCut::crossed);
  EXPECT_EQ(cut_in_space({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {1, 1}}).cut, PolygonCut::whole);
  EXPECT_EQ(cut_in_space({{1, 1}, {1, 1}, {1, 1}, {1, 1}}).cut, PolygonCut::whole);
  EXPECT_EQ(cut_in_space({{0, 0}, {2, 0}, {2, 2}, {0, 2}}).triangle, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

/// Returns the prism over a polygon, 1 high, as OBJ.
std::string prism(const Polygon& polygon) {
  std::string text, top = "f", bottom;
  for (const double z : {0, 1}) {
    for (const auto& p : polygon) text += fmt::format("v {} {} {}\n", p.x(), p.y(), z);
  }
  const std::size_t n = polygon.size();
  for (std::size_t i = 1; i <= n; ++i) {
    top += fmt::format(" {}", n + i);
    bottom += fmt::format(" {}", n + 1 - i);
    text += fmt::format("f {} {} {} {}\n", i, i % n + 1, n + i % n + 1, n + i);
  }
  return text + top + "\nf" + bottom + "\n";
}

TEST(PolygonCut, FacesOfObjAndPlyHaveTheirArea) {
  const Polygon c = {{-0.12, -0.03}, {-0.06, -0.03}, {-0.06, -0.01}, {-0.10, -0.01},
                     {-0.10, 0.01},  {-0.06, 0.01},  {-0.06, 0.03},  {-0.12, 0.03}};
  for (std::size_t first = 0; first < c.size(); ++first) {
    Polygon turned = c;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    const auto read = read_mesh_bytes(prism(turned), "c.obj");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_NEAR(enclosed_volume(read->mesh), 0.0028, 1e-8);
    double area = 0;
    for (std::size_t t = 0; t < read->mesh.triangle.size(); t += 3) {
      const auto at = [&](std::size_t k) {
        const auto& p = read->mesh.position[read->mesh.triangle[t + k]];
        return Vector3d(p.x, p.y, p.z);
      };
      area += (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
    }
    EXPECT_NEAR(area, 0.32 + 2 * 0.0028, 1e-7);
    EXPECT_TRUE(read->said.empty());
  }
  const std::string head =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar uint vertex_index\n"
      "element vertex 4\nproperty float z\nproperty float x\nproperty float y\nend_header\n";
  const auto dart = read_mesh_bytes(head + "4 0 1 2 3\n0 0 0\n0 4 0\n0 1 1\n0 0 4\n", "dart.ply");  // faces in front
  ASSERT_TRUE(dart) << dart.error().message;
  EXPECT_EQ(dart->mesh.triangle.size(), 6U);
  const auto bow = read_mesh_bytes("v 0 0 0\nv 4 4 0\nv 4 0 0\nv 0 4 0\nf 1 2 3 4\nf 4 3 2 1\n", "bow.obj");
  ASSERT_TRUE(bow) << bow.error().message;
  ASSERT_EQ(bow->said.size(), 1U);
  EXPECT_NE(bow->said[0].find("line 5 crosses itself, and 1 more"), std::string::npos) << bow->said[0];
}

TEST(PolygonCut, EndlessFaceIsRefusedWithItsLine) {
  std::string text, face = "f";
  constexpr int corners = 60'000;
  for (int i = 0; i < corners; ++i) {  // turns the wrong way nearly everywhere
    const double angle = 2 * M_PI * i / corners, radius = i % 2 == 0 ? 1 : 2 - 0.5 * std::cos(40 * angle);
    text += fmt::format("v {:.6f} {:.6f} 0\n", radius * std::cos(angle), radius * std::sin(angle));
    face += fmt::format(" {}", i % 7 == 0 ? (i + 30'000) % corners + 1 : i + 1);
  }
  EXPECT_TRUE(is_refused(read_mesh_bytes(text + face + "\n", "a.obj"), "a.obj: line 60001", "60000 corners"));
}

}  // namespace mobil::polygon_cut_test
