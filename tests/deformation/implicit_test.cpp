// The implicit methods' sixteen-lane kernels compared with double precision, and properties of each method.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "assets/fem/muscle_template.h"
#include "tests/deformation/belly_block.h"
#include "tests/engine/instruction_sets.h"
#include "tests/labels.h"

namespace mobil::implicit_test {
using namespace oracle;  // NOLINT(google-build-using-namespace)

/// Returns the smallest number of central-difference substeps that is stable in all lanes with the consistent mass.
std::uint32_t implicit_substeps(const Block& block) {
  const MuscleTemplate& muscle = block.muscle;
  const std::vector<Eigen::Index> moving = free_components(muscle.mesh.cells, muscle.options.far_end);
  const double circular = 2 * std::numbers::pi * muscle.options.foundation_hz;
  double top = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    Model model = oracle::assemble(
        scaled(muscle.mesh, static_cast<double>(block.scale.across[l]), static_cast<double>(block.scale.along[l])),
        muscle.material);
    for (Eigen::Index i = 0; i < model.mass.rows(); ++i)
      if (i % 3 != 2) model.stiffness.row(i) += circular * circular * model.mass.row(i);
    top = std::max(top, eigenvalues(model.stiffness(moving, moving), model.mass(moving, moving)).maxCoeff());
  }
  const double xi = muscle.options.stiffness_damping_s * std::sqrt(top) / 2;
  return substeps_within(2 / std::sqrt(top) * (std::sqrt(1 + xi * xi) - xi), static_cast<double>(tick_s));
}

constexpr std::array<FarEnd, 3> far_ends = {FarEnd::held, FarEnd::sliding, FarEnd::free};
constexpr std::array<const char*, 3> far_end_name = {"held", "sliding", "free"};

struct Physics {
  double alpha, beta, foundation_hz;
  bool framed;
};
constexpr std::array<Physics, 4> physics = {
    {{8, 0, 0, false}, {0, 0, 0, true}, {8, 3e-4, 7, true}, {0, 2e-3, 0, false}}};

void follows(Method method, Mass mass, bool alike, const Cells& cells, int ticks) {
  for (const FarEnd end : far_ends) {
    for (const Physics& p : physics) {
      MuscleOptions options;
      options.far_end = end;
      options.damping_per_s = p.alpha;
      options.stiffness_damping_s = p.beta;
      options.foundation_hz = p.foundation_hz;
      const MuscleTemplate muscle = make(spindle(cells), options);
      Block block(muscle, make_solver(muscle, method, mass, static_cast<double>(tick_s)), 0.06, 0.12);
      if (alike) block.be_all_alike();
      const std::uint32_t n = method == Method::implicit_central ? implicit_substeps(block) : 1;
      const Distance distance = distance_from_reference(block, p.framed, ticks, n);
      const std::string where = std::string(far_end_name[static_cast<std::size_t>(end)]) + ", alpha " +
                                std::to_string(p.alpha) + ", beta " + std::to_string(p.beta) + ", foundation " +
                                std::to_string(p.foundation_hz) + (p.framed ? ", framed" : "");
      const double swept = method == Method::newmark && !alike ? 3 : 1;
      EXPECT_LT(distance.displacement, swept * 1e-4) << where;
      EXPECT_LT(distance.report, swept * 4e-4) << where;
    }
  }
}

TEST(Implicit, MeanAccelerationOfOneBodyFollowsTheReference) {
  follows(Method::newmark, Mass::lumped, true, {2, 2, 8}, 12);
  follows(Method::newmark, Mass::consistent, true, {2, 1, 4}, 60);
}

TEST(Implicit, MeanAccelerationOfIndividualsFollowsTheReference) {
  follows(Method::newmark, Mass::lumped, false, {2, 2, 8}, 12);
  follows(Method::newmark, Mass::consistent, false, {2, 1, 4}, 60);
}

TEST(Implicit, CentralDifferencesWithConsistentMassFollowTheReference) {
  MOBIL_SLOW();
  follows(Method::implicit_central, Mass::consistent, false, {2, 1, 4}, 30);
  follows(Method::implicit_central, Mass::consistent, true, {1, 2, 3}, 30);
}

TEST(Implicit, StaticSolutionsFollowTheReference) {
  MOBIL_SLOW();
  follows(Method::statics, Mass::lumped, false, {2, 2, 8}, 5);
  follows(Method::statics, Mass::consistent, false, {2, 1, 4}, 5);
  follows(Method::statics, Mass::lumped, true, {2, 2, 8}, 5);
}

TEST(Implicit, SolverServesBodiesOfSimilarSize) {
  const MuscleTemplate muscle = make(spindle({1, 2, 4}), {FarEnd::free, 2});
  for (const Method method : {Method::newmark, Method::statics}) {
    Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s), 1.3, 0.9), 0.06, 0.12);
    EXPECT_LT(distance_from_reference(block, true, 20, 1).displacement, 1e-4);
  }
}

TEST(Implicit, MoreSweepsAreMoreAccurate) {
  const MuscleTemplate muscle = make(spindle({2, 2, 4}), {FarEnd::free, 2});
  for (const Method method : {Method::newmark, Method::statics}) {
    std::vector<double> distance;
    for (const std::uint32_t sweeps : {2U, 4U, 6U}) {
      Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s)), 0.12, 0.25);
      block.solver.sweeps = sweeps;
      distance.push_back(distance_from_reference(block, false, 20, 1).displacement);
    }
    EXPECT_LT(distance[1], 0.2 * distance[0]);
    EXPECT_LT(distance[2], std::max(0.2 * distance[1], 5e-5));
  }
}

TEST(Implicit, OneLayerOfElementsMovesOrIsFullyHeld) {
  for (const FarEnd end : far_ends) {
    const MuscleTemplate muscle = make(*make_block({1, 1, 1}, 0.02), {end, 3});
    for (const Method method : {Method::newmark, Method::statics}) {
      Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s)), 0.05, 0.1);
      if (end != FarEnd::held) {
        EXPECT_LT(distance_from_reference(block, true, 20, 1).displacement, 1e-4);
        continue;
      }
      const EndPull drive = drive_at(0.1, 1, true);
      block.tick(drive, 1);
      for (std::size_t i = 0; i < block.u.size(); ++i) {
        const bool is_far_z = i >= 12 && i % 3 == 2;
        for (std::size_t l = 0; l < lane_count; ++l)
          EXPECT_FLOAT_EQ(block.u[i][l], is_far_z ? drive.displacement.to[l] : 0);
      }
    }
  }
}

TEST(Implicit, FreeUndampedMotionKeepsItsEnergy) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    for (const bool alike : {true, false}) {
      const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::free, 0});
      Block block(muscle, make_solver(muscle, Method::newmark, mass, static_cast<double>(tick_s)), 0.06, 0.12);
      block.solver.sweeps = 5;
      if (alike) block.be_all_alike();
      shake(block, 0.002F);
      block.tick(EndPull{}, 1);
      std::vector<double> first(lane_count);
      for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(block, l);
      for (int tick = 0; tick < 300; ++tick) block.tick(EndPull{}, 1);
      for (std::size_t l = 0; l < lane_count; ++l) EXPECT_NEAR(energy(block, l) / first[l], 1, 5e-5) << "lane " << l;
    }
  }
}

TEST(Implicit, OnlyMeanAccelerationIsStableAtAnyStep) {
  for (const float length_s : {tick_s, 1.0F}) {
    const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::free, 0});
    Block block(muscle, make_solver(muscle, Method::newmark, Mass::lumped, static_cast<double>(length_s)), 0.06, 0.12);
    shake(block, 0.001F);
    for (int tick = 0; tick < 1000; ++tick) block.tick(EndPull{}, 1, length_s);
    EXPECT_LT(largest(block), 0.1);

    Block lost(muscle, make_solver(muscle, Method::implicit_central, Mass::consistent, static_cast<double>(length_s)),
               0, 0);
    shake(lost, 0.001F);
    for (int tick = 0; tick < 40; ++tick) lost.tick(EndPull{}, 1, length_s);
    EXPECT_GT(largest(lost), 1e6);
  }
}

TEST(Implicit, ConsistentCentralDifferencesKeepEnergyUpToTheirLimit) {
  const MuscleTemplate muscle = make(spindle({2, 2, 4}), {FarEnd::free, 0});
  Block block(muscle, make_solver(muscle, Method::implicit_central, Mass::consistent, static_cast<double>(tick_s)), 0.2,
              0.2);
  shake(block, 0.001F);
  const std::uint32_t n = implicit_substeps(block);
  block.tick(EndPull{}, n);
  std::vector<double> first(lane_count);
  for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(block, l);
  for (int tick = 0; tick < 300; ++tick) block.tick(EndPull{}, n);
  for (std::size_t l = 0; l < lane_count; ++l) EXPECT_NEAR(energy(block, l) / first[l], 1, 5e-5) << "lane " << l;
}

TEST(Implicit, SlenderBelliesBendToTheStaticSolution) {
  for (const bool alike : {true, false}) {
    const MuscleTemplate muscle = make(*make_block({1, 1, 12}, 0.004), {FarEnd::free, 0});  // condition 1.3e5
    Block block(muscle, make_solver(muscle, Method::statics, Mass::lumped, 0), 0.06, 0.12);
    if (alike) block.be_all_alike();
    EXPECT_LT(distance_from_reference(block, false, 10, 1).displacement, 1e-3);
  }
}

TEST(Implicit, RestStaysAtRest) {
  for (const Method method : {Method::newmark, Method::implicit_central, Method::statics}) {
    const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::held, 8});
    Block block(muscle, make_solver(muscle, method, Mass::consistent, static_cast<double>(tick_s)), 0.06, 0.12);
    for (int tick = 0; tick < 3; ++tick) block.tick(EndPull{}, 8);
    for (const auto& column : {block.u, block.v}) {
      for (const auto& lanes : column) {
        for (const float x : lanes.lane) ASSERT_EQ(x, 0.0F);
      }
    }
  }
}

TEST(Implicit, NonsenseSolversAreRefusedInOneLine) {
  const MuscleTemplate muscle = make(*make_block({1, 1, 2}, 0.01), {FarEnd::held, 0, 0.5, 2});
  const auto refused = [&](Method method, double dt, double across = 1, double along = 1) {
    const auto made = make_belly_solver(muscle, method, Mass::lumped, dt, across, along);
    return !made && !made.error().message.empty() && made.error().message.find('\n') == std::string::npos;
  };
  EXPECT_FALSE(refused(Method::newmark, 0.01));
  EXPECT_FALSE(refused(Method::statics, -1));
  EXPECT_TRUE(refused(Method::explicit_central, 0.01));
  for (const double bad : {0.0, -0.01, 1e9, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_TRUE(refused(Method::newmark, bad));
    EXPECT_TRUE(refused(Method::implicit_central, bad));
    EXPECT_TRUE(refused(Method::newmark, 0.01, bad, bad));
  }
  EXPECT_TRUE(refused(Method::newmark, 0.01, 3, 1));
  EXPECT_TRUE(refused(Method::newmark, 0.01, 1, 3));
  const auto wide = make(*make_block({40, 40, 2}, 0.01), {FarEnd::free, 0, 1, 1});
  EXPECT_FALSE(make_belly_solver(wide, Method::newmark, Mass::lumped, 0.01).has_value());
}

}  // namespace mobil::implicit_test
