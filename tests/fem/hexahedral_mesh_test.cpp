// Structured blocks: numbering, boundary, quality, refusals.
#include <mobil/assets/fem/hexahedral_mesh.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "assets/fem/element_size.h"
#include "assets/fem/stiffness_terms.h"
#include "tests/fem/oracle.h"

namespace mobil::hexahedral_mesh_test {
Cells any_cells(std::uint32_t across = 4, std::uint32_t along = 9) {
  return {*rc::gen::inRange(1U, across), *rc::gen::inRange(1U, across), *rc::gen::inRange(1U, along)};
}

/// Returns the stations of a belly with moderate curvature and taper.
std::vector<LatticeStation> any_belly() {
  const auto length = [](int low_mm, int high_mm) {
    return static_cast<float>(*rc::gen::inRange(low_mm, high_mm)) * 1e-3F;
  };
  std::vector<LatticeStation> stations;
  for (const float t : {0.0F, 0.3F, 0.65F, 1.0F}) {
    stations.push_back({t, length(-15, 15), length(-15, 15), length(20, 40), length(20, 40)});
  }
  return stations;
}

const std::vector<LatticeStation> fixed_belly = {
    {0, 0.01F, 0, 0.02F, 0.03F}, {0.4F, 0, 0.01F, 0.03F, 0.035F}, {1, 0, 0, 0.02F, 0.02F}};

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

RC_GTEST_PROP(HexahedralMesh, BlockHasItsNodesVolumeAndPerfectElements, ()) {
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
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.7F * x, 0.7F * y}, {0.5F, bow, 0, x, y}, {1, 0, 0, 0.7F * x, 0.7F * y}};
  const auto mesh = bend_block(cells, stations, 0.3);
  RC_ASSERT(mesh.has_value());
  RC_ASSERT(smallest_scaled_jacobian(*mesh) >= 0.3);
}

TEST(HexahedralMesh, RoundedSectionTouchesItsEllipseAndContainsIt) {
  const std::vector<LatticeStation> stations = {{0, 0.01F, -0.02F, 0.03F, 0.02F}, {1, 0.01F, -0.02F, 0.03F, 0.02F}};
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

RC_GTEST_PROP(HexahedralMesh, GradedElementsFillTheBlockAndGrowTowardTheMiddle, ()) {
  const Cells cells = any_cells(6, 12);
  const Grading grading{*rc::gen::inRange(1, 400) * 0.05, *rc::gen::inRange(1, 400) * 0.05};
  const auto uniform = make_block(cells, 0.01), graded = make_block(cells, 0.01, grading);
  RC_ASSERT(graded.has_value());
  RC_ASSERT(std::abs(volume(*graded) / volume(*uniform) - 1) < 1e-12);
  RC_ASSERT(smallest_scaled_jacobian(*graded) > 1 - 1e-9);
  RC_ASSERT(graded->node.front().x == uniform->node.front().x);
  RC_ASSERT(std::abs(graded->node.back().z - uniform->node.back().z) < 1e-15);
  std::vector<double> length;
  for (std::uint32_t k = 0; k < cells[2]; ++k) {
    length.push_back(graded->node[node_index(cells, 0, 0, k + 1)].z - graded->node[node_index(cells, 0, 0, k)].z);
  }
  const std::size_t half = length.size() / 2;
  if (length.size() % 2 == 0) {
    const double whole = std::pow(grading.along, 1 - 1 / static_cast<double>(half));
    RC_ASSERT(std::abs(length[half - 1] / length[0] / whole - 1) < 1e-9);
  }
  for (std::size_t k = 0; k < length.size(); ++k) {
    RC_ASSERT(length[k] > 0);
    RC_ASSERT(std::abs(length[k] - length[length.size() - 1 - k]) < 1e-14);
    if (k >= 1 && k + 1 < half) RC_ASSERT(std::abs(length[k] * length[k] / (length[k - 1] * length[k + 1]) - 1) < 1e-9);
  }
}

TEST(HexahedralMesh, GradedBelliesStayWithinTheSameEllipses) {
  const auto uniform = bend_block({4, 4, 10}, fixed_belly, 0.2),
             graded = bend_block({4, 4, 10}, fixed_belly, 0.2, {3, 4});
  ASSERT_TRUE(graded.has_value());
  EXPECT_NEAR(volume(*graded) / volume(*uniform), 1, 0.05);
  EXPECT_LT(graded->node[plane_nodes({4, 4, 10})].z, 0.6 * uniform->node[plane_nodes({4, 4, 10})].z);
}

/// Returns true if every node of the coarse block is a node of the fine block.
bool nested(const Cells& coarse, const Cells& fine) {
  const Grading grading{2, 3};
  const auto a = make_block(coarse, 0.12 / coarse[0], grading), b = make_block(fine, 0.12 / fine[0], grading);
  for (std::uint32_t n = 0; n < 3; ++n) {
    if (fine[n] % coarse[n] != 0) return false;
  }
  bool same = true;
  for_each_node(coarse, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    const auto times = [&](std::size_t d) { return fine[d] / coarse[d]; };
    const auto& p = a->node[node_index(coarse, i, j, k)];
    const auto& q = b->node[node_index(fine, i * times(0), j * times(1), k * times(2))];
    same = same && std::abs(p.x - q.x) + std::abs(p.y - q.y) + std::abs(p.z - q.z) < 1e-12;
  });
  return same;
}

TEST(HexahedralMesh, PaperAndIntermediateBlocksNest) {
  const std::pair<Cells, std::uint32_t> blocks[] = {{{2, 2, 8}, 81},   {{2, 2, 10}, 99},   {{4, 4, 16}, 425},
                                                    {{4, 4, 20}, 525}, {{8, 8, 32}, 2673}, {{8, 8, 40}, 3321}};
  for (const auto& [cells, nodes] : blocks) {
    EXPECT_EQ(node_count(cells), nodes);
    EXPECT_TRUE(make_block(cells, 0.01).has_value());
  }
  EXPECT_TRUE(nested({2, 2, 8}, {4, 4, 16}));
  EXPECT_TRUE(nested({4, 4, 16}, {8, 8, 32}));
  EXPECT_TRUE(nested({2, 2, 10}, {4, 4, 20}));
  EXPECT_TRUE(nested({4, 4, 20}, {8, 8, 40}));
  EXPECT_FALSE(nested({2, 2, 8}, {4, 4, 20}));
}

TEST(ElementSize, PaperMaterialAllowsThirtyMillimetreElements) {
  EXPECT_NEAR(compression_wave_speed(Material{}), 4, 1e-3);
  EXPECT_NEAR(largest_element_m(Material{}), 0.030, 1e-5);
}

RC_GTEST_PROP(ElementSize, GrowsWithTheSpeedOfCompressionWaves, ()) {
  const double poisson = *rc::gen::inRange(-50, 49) * 0.01, times = *rc::gen::inRange(1, 100) * 0.1;
  const Material soft{1000, 1e4, poisson}, stiff{1000, 1e4 * times * times, poisson},
      heavy{1000 * times * times, 1e4, poisson};
  RC_ASSERT(std::abs(largest_element_m(stiff) / largest_element_m(soft) / times - 1) < 1e-12);
  RC_ASSERT(std::abs(largest_element_m(heavy) / largest_element_m(soft) * times - 1) < 1e-12);
  // λ and μ by their definitions
  const double lambda = 1e4 * poisson / ((1 + poisson) * (1 - 2 * poisson)), mu = 1e4 / (2 * (1 + poisson));
  RC_ASSERT(std::abs(compression_wave_speed(soft) / std::sqrt((lambda + 2 * mu) / 1000) - 1) < 1e-12);
}

TEST(HexahedralMesh, NonsenseIsRefused) {
  for (const double bad : {0.0, -1.0, 1e-3, 101.0, std::nan("")}) {
    EXPECT_FALSE(make_block({2, 2, 4}, 0.01, {bad, 1}));
    EXPECT_FALSE(bend_block({2, 2, 4}, fixed_belly, 0.2, {1, bad}));
  }
  EXPECT_FALSE(make_block({0, 2, 2}, 0.01));
  EXPECT_FALSE(make_block({2, 2, 257}, 0.01));
  EXPECT_FALSE(make_block({60, 60, 60}, 0.01));
  for (const double size : {0.0, -1.0, std::nan(""), 1e9, double{INFINITY}}) EXPECT_FALSE(make_block({2, 2, 2}, size));
  const LatticeStation good{0, 0, 0, 0.02F, 0.02F}, end{1, 0, 0, 0.02F, 0.02F};
  const auto bent = [&](std::vector<LatticeStation> s, double length) { return bend_block({2, 2, 4}, s, length); };
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

}  // namespace mobil::hexahedral_mesh_test
