// Bellies at finite strain in double precision: forces and tangents, volumes, and the committed tables.
#include "assets/finite/finite_belly.h"

#include <gtest/gtest.h>

#include <cmath>

#include <mobil/muscle_table.h>
#include "assets/finite/control_points.h"
#include "assets/finite/finite_shape.h"
#include "assets/finite/shape_tables.h"
#include "tests/labels.h"

namespace mobil::finite_belly_test {
namespace {

std::vector<Muscle> every_muscle() {
  std::vector<Muscle> all;
  for (std::size_t m = 0; m < muscles().size(); ++m) all.push_back(static_cast<Muscle>(m));
  return all;
}

/// Returns the area of a plane of control points: the four cells of a 3×3 section, seen along z.
double section_area(const HexahedralMesh& mesh, const std::vector<double>& moved, std::uint32_t k) {
  double area = 0;
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t n = node_index(mesh.cells, i, j, k);
    const double x = mesh.node[n].x + (moved.empty() ? 0 : moved[3 * n]);
    const double y = mesh.node[n].y + (moved.empty() ? 0 : moved[3 * n + 1]);
    return std::pair(x, y);
  };
  for (std::uint32_t j = 0; j < mesh.cells[1]; ++j) {
    for (std::uint32_t i = 0; i < mesh.cells[0]; ++i) {
      const auto [ax, ay] = at(i, j);
      const auto [bx, by] = at(i + 1, j);
      const auto [cx, cy] = at(i + 1, j + 1);
      const auto [dx, dy] = at(i, j + 1);
      area += 0.5 * ((cx - ax) * (dy - by) - (dx - bx) * (cy - ay));
    }
  }
  return area;
}

std::vector<double> tabled(Muscle muscle, double ratio, double shortening, double activation) {
  const ShapeTable table = shape_table(muscle);
  return shape_at(table, body_coefficients(table, ratio), finite_mesh(muscle, table.control), shortening, activation);
}

/// The displayed shape keeps its volume for any muscle, body, shortening and activation.
TEST(FiniteShapes, KeepTheirVolume) {
  for (const Muscle muscle : every_muscle()) {
    const HexahedralMesh mesh = finite_mesh(muscle, {2, 2, 8});
    for (const double ratio : {0.8, 0.9, 1.0, 1.1, 1.26}) {
      for (double e = -0.2; e < 0.2501; e += 0.025) {
        for (const double a : {0.0, 0.01, 0.05, 0.2, 0.5, 1.0}) {
          EXPECT_NEAR(enclosed_volume(mesh, tabled(muscle, ratio, e, a)), 1, 0.011)
              << muscle_name(muscle) << " r " << ratio << " e " << e << " a " << a;
        }
      }
    }
  }
}

/// With uniform strain, a section grows by 1 / (1 − e).
TEST(FiniteShapes, SectionsGrowAsBelliesShorten) {
  for (const Muscle muscle : every_muscle()) {
    const HexahedralMesh mesh = finite_mesh(muscle, {2, 2, 8});
    for (const double a : {0.1, 0.4, 1.0}) {
      double before = 0;
      for (const double e : {-0.15, 0.0, 0.1, 0.2}) {
        const double grown = section_area(mesh, tabled(muscle, 1, e, a), 4) / section_area(mesh, {}, 4);
        EXPECT_GT(grown, before) << muscle_name(muscle) << " e " << e << " a " << a;
        before = grown;
        EXPECT_NEAR(grown, 1 / (1 - e), 0.12) << muscle_name(muscle) << " e " << e << " a " << a;
      }
    }
  }
}

TEST(FiniteShapes, RestIsUndeformedAndEndsFollowTheirDrive) {
  for (const Muscle muscle : every_muscle()) {
    const HexahedralMesh mesh = finite_mesh(muscle, {2, 2, 8});
    for (const double x : tabled(muscle, 1.1, 0, 0)) EXPECT_EQ(x, 0);
    const auto shape = tabled(muscle, 1.1, 0.1, 0.5);
    for (std::size_t i = 0; i < 27; ++i) EXPECT_EQ(shape[i], 0);
    const double length = mesh.node.back().z - mesh.node.front().z;
    for (std::size_t i = shape.size() - 27; i < shape.size(); ++i)
      EXPECT_NEAR(shape[i], i % 3 == 2 ? -0.1 * length : 0, 1e-12);
  }
}

/// Compares with new solutions between the samples of the tables.
TEST(FiniteShapes, TablesMatchTheSolver) {
  MOBIL_SLOW();
  for (const char* const name : {"tibialis_anterior", "gastrocnemius_medial", "vastus_lateralis"}) {
    const Muscle muscle = *find_muscle(name);
    const std::array shortenings = {-0.075, 0.075}, activations = {0.1, 0.5};
    const auto samples = shape_samples(sampled_belly(muscle), 1.1, shortenings, activations);
    ASSERT_TRUE(samples) << samples.error().message;
    const ShapeErrors errors = shape_errors(shape_table(muscle), finite_mesh(muscle, {2, 2, 8}), *samples);
    EXPECT_LT(errors.rms, 0.04) << name;
    EXPECT_LT(errors.worst, 0.06) << name;
    EXPECT_LT(errors.farthest_m, 0.0012) << name;
  }
}

TEST(FiniteShapes, FinerControlPointsInterpolateTheTables) {
  for (const char* const name : {"soleus", "rectus_femoris"}) {
    const Muscle muscle = *find_muscle(name);
    const Cells fine{4, 4, 16};
    const HexahedralMesh coarse_mesh = finite_mesh(muscle, {2, 2, 8}), fine_mesh = finite_mesh(muscle, fine);
    StaticStretch none_coarse, none_fine;
    none_coarse.displacement.resize(3 * coarse_mesh.node.size());
    none_fine.displacement.resize(3 * fine_mesh.node.size());
    const FiniteShape coarse = make_finite_shape(muscle, coarse_mesh, none_coarse);
    const FiniteShape finer = make_finite_shape(muscle, fine_mesh, none_fine);
    float most = 0, step = 0;
    for (std::uint32_t k = 0; k <= 16; ++k) {
      for (std::uint32_t j = 0; j <= 4; ++j) {
        for (std::uint32_t i = 0; i <= 4; ++i) {
          const std::size_t at = 3 * shape_modes * node_index(fine, i, j, k);
          if (i % 2 + j % 2 + k % 2 == 0) {
            const std::size_t in_coarse = 3 * shape_modes * node_index({2, 2, 8}, i / 2, j / 2, k / 2);
            for (std::size_t w = 0; w < 3 * shape_modes; ++w)
              ASSERT_NEAR(finer.vector[at + w], coarse.vector[in_coarse + w], 1e-6F);
          }
          if (k == 0) continue;
          const std::size_t below = 3 * shape_modes * node_index(fine, i, j, k - 1);
          for (std::size_t w = 0; w < 3 * shape_modes; ++w) {
            most = std::max(most, std::abs(finer.vector[at + w]));
            step = std::max(step, std::abs(finer.vector[at + w] - finer.vector[below + w]));
          }
        }
      }
    }
    EXPECT_LT(step, most) << name << ": no wilder than the table";
  }
}

/// The tangent is the derivative of the forces, at a shape far from rest.
TEST(FiniteBelly, TangentIsTheDerivativeOfForces) {
  const Muscle muscle = *find_muscle("gastrocnemius_medial");
  const auto belly = make_finite_belly(finite_mesh(muscle, {2, 2, 4}), {}, 50);
  ASSERT_TRUE(belly) << belly.error().message;
  FiniteScratch scratch = make_scratch(*belly);
  FiniteState state = state_at_rest(*belly);
  const auto there = settle(*belly, scratch, state, 0.1, 0.4);
  ASSERT_TRUE(there) << there.error().message;
  EXPECT_LT(worst_dilatation(*belly, state), 0.05);
  EXPECT_NEAR(volume_ratio(*belly, state), 1, 0.01);
  // The belly returns to the same shape: one load has one shape.
  const auto there_and_back = [&](double e, double a) {
    ASSERT_TRUE(settle(*belly, scratch, state, e, a));
    ASSERT_TRUE(settle(*belly, scratch, state, 0, 0));
    for (const double u : state.displacement_m) EXPECT_NEAR(u, 0, 1e-9);
  };
  there_and_back(0.2, 1);
  there_and_back(-0.2, 0);
  // Quadratic convergence needs few steps; a wrong tangent needs many.
  scratch.iterations = scratch.halvings = 0;
  ASSERT_TRUE(settle(*belly, scratch, state, 0.05, 0.3));
  EXPECT_LE(scratch.iterations, 20U);
  EXPECT_EQ(scratch.halvings, 0U);
}

TEST(FiniteBelly, BadRequestsAreRefused) {
  const Muscle muscle = *find_muscle("soleus");
  EXPECT_FALSE(make_finite_belly(finite_mesh(muscle, {2, 2, 4}), {}, 2000));
  const auto belly = make_finite_belly(finite_mesh(muscle, {2, 2, 4}), {}, 50);
  FiniteScratch scratch = make_scratch(*belly);
  FiniteState state = state_at_rest(*belly);
  EXPECT_FALSE(settle(*belly, scratch, state, 0.7, 0));
  EXPECT_FALSE(settle(*belly, scratch, state, 0, 1.5));
  EXPECT_FALSE(settle(*belly, scratch, state, std::nan(""), 0));
  for (const double u : state.displacement_m) EXPECT_EQ(u, 0);
}

}  // namespace
}  // namespace mobil::finite_belly_test
