// Structured blocks: numbering, boundary, quality, refusals.
#include "assets/hexahedral_mesh.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "tests/oracle.h"

namespace mobil {
namespace {

Cells any_cells(std::uint32_t across = 4, std::uint32_t along = 9) {
  return {*rc::gen::inRange(1U, across), *rc::gen::inRange(1U, across), *rc::gen::inRange(1U, along)};
}

/// A belly of moderate curvature and taper.
std::vector<CageStation> any_belly() {
  const auto length = [](int low_mm, int high_mm) {
    return static_cast<float>(*rc::gen::inRange(low_mm, high_mm)) * 1e-3F;
  };
  std::vector<CageStation> stations;
  for (const float t : {0.0F, 0.3F, 0.65F, 1.0F}) {
    stations.push_back({t, length(-15, 15), length(-15, 15), length(20, 40), length(20, 40)});
  }
  return stations;
}

double volume_by_gauss(const HexahedralMesh& mesh) {
  double sum = 0;
  const double g = 1 / std::sqrt(3.0);
  for (std::uint32_t e = 0; e < element_count(mesh.cells); ++e) {
    for (int p = 0; p < 8; ++p) {
      const auto side = [&](int bit) { return (p >> bit) % 2 == 0 ? -g : g; };
      sum += oracle::shape_at(mesh, element_nodes(mesh.cells, e), side(0), side(1), side(2)).jacobian;
    }
  }
  return sum;
}

RC_GTEST_PROP(HexahedralMesh, BlockHasItsNodesItsVolumeAndPerfectElements, ()) {
  const Cells cells = any_cells();
  const double size = *rc::gen::inRange(1, 100) * 1e-3;
  const auto mesh = make_block(cells, size);
  RC_ASSERT(mesh.has_value());
  RC_ASSERT(mesh->node.size() == (cells[0] + 1U) * (cells[1] + 1U) * (cells[2] + 1U));
  const double expected = element_count(cells) * size * size * size;
  RC_ASSERT(std::abs(volume(*mesh) / expected - 1) < 1e-12);
  RC_ASSERT(std::abs(smallest_scaled_jacobian(*mesh) - 1) < 1e-12);
  RC_ASSERT(mesh->node.front().z == 0.0);
  RC_ASSERT(std::abs(mesh->node[first_insertion_node(cells)].z - cells[2] * size) < 1e-12);
  RC_ASSERT(first_insertion_node(cells) + plane_nodes(cells) == mesh->node.size());
}

RC_GTEST_PROP(HexahedralMesh, BoundaryIsClosedAndWoundOutwards, ()) {
  const Cells cells = any_cells();
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Quad& q : boundary_quads(cells)) {
    for (std::size_t i = 0; i < 4; ++i) ++edges[{q[i], q[(i + 1) % 4]}];
  }
  for (const auto& [edge, count] : edges) {
    RC_ASSERT(count == 1);
    RC_ASSERT(edges.count({edge.second, edge.first}) == 1U);
  }
  RC_ASSERT(volume(*make_block(cells, 0.01)) > 0);
}

RC_GTEST_PROP(HexahedralMesh, BellyVolumeEqualsItsGaussSum, ()) {
  const auto mesh = bend_block(any_cells(), any_belly(), 0.25);
  RC_ASSERT(mesh.has_value());
  RC_ASSERT(std::abs(volume(*mesh) / volume_by_gauss(*mesh) - 1) < 1e-12);
}

RC_GTEST_PROP(HexahedralMesh, BellyElementsStayWellShaped, ()) {
  const Cells cells = {2 * *rc::gen::inRange(1U, 4U), 2 * *rc::gen::inRange(1U, 4U), *rc::gen::inRange(6U, 24U)};
  const float x = static_cast<float>(*rc::gen::inRange(20, 40)) * 1e-3F;
  const float y = x * static_cast<float>(*rc::gen::inRange(75, 134)) * 1e-2F;
  const float bow = static_cast<float>(*rc::gen::inRange(-20, 21)) * 1e-3F;
  const std::vector<CageStation> stations = {
      {0, 0, 0, 0.7F * x, 0.7F * y}, {0.5F, bow, 0, x, y}, {1, 0, 0, 0.7F * x, 0.7F * y}};
  const auto mesh = bend_block(cells, stations, 0.3);
  RC_ASSERT(mesh.has_value());
  RC_ASSERT(smallest_scaled_jacobian(*mesh) >= 0.3);
}

TEST(HexahedralMesh, RoundedSectionTouchesItsEllipseAndContainsIt) {
  const std::vector<CageStation> stations = {{0, 0.01F, -0.02F, 0.03F, 0.02F}, {1, 0.01F, -0.02F, 0.03F, 0.02F}};
  const auto mesh = bend_block({8, 8, 1}, stations, 0.1);
  ASSERT_TRUE(mesh.has_value());
  double widest = 0, smallest = 1e9;
  for (std::uint32_t j = 0; j <= 8; ++j) {
    for (std::uint32_t i = 0; i <= 8; ++i) {
      const auto& p = mesh->node[node_index(mesh->cells, i, j, 0)];
      widest = std::max(widest, std::abs(p.x - 0.01));
      const bool rim = i % 8 == 0 || j % 8 == 0;
      if (rim) smallest = std::min(smallest, std::hypot((p.x - 0.01) / 0.03, (p.y + 0.02) / 0.02));
    }
  }
  EXPECT_NEAR(widest, 0.03, 1e-8);
  EXPECT_GE(smallest, 1 - 1e-7);
}

TEST(HexahedralMesh, InvertedElementIsNamed) {
  auto mesh = make_block({2, 2, 3}, 0.01);
  ASSERT_TRUE(mesh.has_value());
  mesh->node[node_index(mesh->cells, 1, 1, 3)].z = -0.05;  // belongs to the last four elements
  const auto checked = check_elements(*mesh);
  ASSERT_FALSE(checked.has_value());
  EXPECT_NE(checked.error().message.find("element 8 "), std::string::npos) << checked.error().message;
}

TEST(HexahedralMesh, NonsenseIsRefused) {
  EXPECT_FALSE(make_block({0, 2, 2}, 0.01));
  EXPECT_FALSE(make_block({2, 2, 257}, 0.01));
  EXPECT_FALSE(make_block({60, 60, 60}, 0.01));
  for (const double size : {0.0, -1.0, std::nan(""), 1e9, double{INFINITY}}) EXPECT_FALSE(make_block({2, 2, 2}, size));
  const CageStation good{0, 0, 0, 0.02F, 0.02F}, end{1, 0, 0, 0.02F, 0.02F};
  const auto bent = [&](std::vector<CageStation> s, double length) { return bend_block({2, 2, 4}, s, length); };
  EXPECT_TRUE(bent({good, end}, 0.2));
  EXPECT_FALSE(bent({good}, 0.2));
  EXPECT_FALSE(bent({end, good}, 0.2));
  EXPECT_FALSE(bent({good, {0.5F, 0, 0, 0.02F, 0.02F}}, 0.2));
  EXPECT_FALSE(bent({good, {1, NAN, 0, 0.02F, 0.02F}}, 0.2));
  EXPECT_FALSE(bent({good, {1, 0, 0, 0, 0.02F}}, 0.2));
  EXPECT_FALSE(bent({good, {1, 0, 0, 0.02F, -0.02F}}, 0.2));
  EXPECT_FALSE(bent({good, end}, 0));
  EXPECT_FALSE(bent({good, end}, std::nan("")));
}

TEST(HexahedralMesh, CentreOfTheFarFaceIsOneTwoOrFourNodes) {
  EXPECT_EQ(insertion_centre({2, 2, 8}), (std::vector<std::uint32_t>{76}));
  EXPECT_EQ(insertion_centre({3, 2, 1}).size(), 2U);
  const auto four = insertion_centre({3, 3, 2});
  ASSERT_EQ(four.size(), 4U);
  const auto mesh = make_block({3, 3, 2}, 0.01);
  double x = 0, y = 0;
  for (const auto n : four) {
    EXPECT_NEAR(mesh->node[n].z, 0.02, 1e-15);
    x += mesh->node[n].x;
    y += mesh->node[n].y;
    EXPECT_NEAR(std::hypot(mesh->node[n].x, mesh->node[n].y), 0.005 * std::numbers::sqrt2, 1e-12);
  }
  EXPECT_NEAR(x, 0, 1e-15);
  EXPECT_NEAR(y, 0, 1e-15);
}

}  // namespace
}  // namespace mobil
