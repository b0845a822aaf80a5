// The explicit sixteen-lane kernel compared with double precision, and properties that any such kernel must have.
#include "systems/deformation/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "assets/fem/muscle_template.h"
#include "tests/deformation/belly_block.h"

namespace mobil::deformation_test {
using namespace oracle;  // NOLINT(google-build-using-namespace)

MuscleTemplate make(const Cells& cells, FarEnd end, double damping) {
  return oracle::make(spindle(cells), {end, damping, 0.25, 4});
}

/// Returns a block at rest with sixteen sizes.
Block stepped_explicitly(const MuscleTemplate& muscle) {
  return {muscle, make_solver(muscle, Method::explicit_central, Mass::lumped, 0), 0.42, 0.35};
}

std::uint32_t substeps(const Block& block) {
  std::uint32_t most = 1;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto limit = critical_step(block.muscle.critical_steps, static_cast<double>(block.scale.across[l]),
                                     static_cast<double>(block.scale.along[l]));
    most = std::max(most, substeps_within(limit.value(), static_cast<double>(tick_s)));
  }
  return most;
}

TEST(Deformation, FollowsTheReferenceForASecondForAnyDrive) {
  for (const FarEnd end : {FarEnd::held, FarEnd::sliding, FarEnd::free}) {
    for (const bool alike : {false, true}) {
      const MuscleTemplate muscle = make({2, 2, 8}, end, alike ? 0 : 8);
      Block block = stepped_explicitly(muscle);
      if (alike) block.be_all_alike();
      const Distance distance = distance_from_reference(block, false, 60, substeps(block));
      EXPECT_LT(distance.displacement, 3e-5) << static_cast<int>(end) << alike;
      EXPECT_LT(distance.report, 2e-4) << static_cast<int>(end) << alike;
    }
  }
}

// Longer elements make a belly softer and rounding errors relatively larger.
TEST(Deformation, OtherMeshesFollowTheReference) {
  for (const Cells& cells : {Cells{1, 1, 1}, Cells{1, 3, 2}, Cells{4, 2, 3}}) {
    for (const FarEnd end : {FarEnd::held, FarEnd::free}) {
      if (end == FarEnd::held && cells[2] == 1) continue;  // nothing moves
      const MuscleTemplate muscle = make(cells, end, 2);
      Block block = stepped_explicitly(muscle);
      const Distance distance = distance_from_reference(block, false, 60, substeps(block));
      EXPECT_LT(distance.displacement, end == FarEnd::free ? 1e-4 : 3e-5);
      EXPECT_LT(distance.report, 2e-4);
    }
  }
}

TEST(Deformation, FreeUndampedMotionKeepsItsEnergy) {
  const MuscleTemplate muscle = make({2, 2, 8}, FarEnd::free, 0);
  Block block = stepped_explicitly(muscle);
  shake(block, 0.002F);
  const auto n = substeps(block);
  block.tick({}, n);
  std::vector<double> first(lane_count);
  for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(block, l);
  double lowest_share = 1;
  for (int tick = 0; tick < 300; ++tick) {
    block.tick({}, n);
    for (std::size_t l = 0; l < lane_count; ++l) {
      ASSERT_NEAR(energy(block, l) / first[l], 1, 2e-5) << "lane " << l << " tick " << tick;
      lowest_share = std::min(lowest_share, static_cast<double>(block.report.kinetic_energy_j[l]) / first[l]);
    }
  }
  EXPECT_LT(lowest_share, 0.4);  // it does swing between the two
}

TEST(Deformation, StableAtTheLimitAndUnstableJustAboveIt) {
  constexpr double across = static_cast<double>(1.2F), along = static_cast<double>(0.9F);
  const MuscleTemplate muscle = make({2, 2, 8}, FarEnd::free, 0);
  for (const bool above : {false, true}) {
    Block block = stepped_explicitly(muscle);
    for (std::size_t l = 0; l < lane_count; ++l) block.scale.across[l] = 1.2F, block.scale.along[l] = 0.9F;
    shake(block, 1e-3F);
    const double limit = critical_step(muscle.terms, across, along, FarEnd::free);
    const double exact = 2 / highest_frequency(oracle::assemble(scaled(muscle.mesh, across, along), muscle.material),
                                               free_components({2, 2, 8}, FarEnd::free));
    const auto dt = static_cast<float>(above ? 1.005 * exact : limit);
    for (int step = 0; step < 3000; ++step) block.tick({}, 1, dt);
    if (above) {
      EXPECT_GT(largest(block), 1e6);
    } else {
      EXPECT_LT(largest(block), 0.5);  // a mode at the limit can beat, but not grow
      EXPECT_GT(largest(block), 1e-5);
    }
  }
}

TEST(Deformation, VolumeMatchesTheDeformedMesh) {
  for (const auto end : {FarEnd::held, FarEnd::free}) {
    const MuscleTemplate muscle = make({3, 2, 5}, end, 0);
    Block block = stepped_explicitly(muscle);
    shake(block, 0.002F);
    EndPull drive;
    for (std::size_t l = 0; l < lane_count; ++l) drive.displacement.from[l] = drive.displacement.to[l] = 0.01F;
    block.tick(drive, 1, 1e-9F);
    for (std::size_t l = 0; l < lane_count; ++l) {
      auto mesh =
          scaled(muscle.mesh, static_cast<double>(block.scale.across[l]), static_cast<double>(block.scale.along[l]));
      const double rest = volume(mesh);
      const Vector u = block.lane(block.u, l);
      for (std::size_t n = 0; n < mesh.node.size(); ++n) {
        const auto i = static_cast<Eigen::Index>(3 * n);
        mesh.node[n] = {mesh.node[n].x + u(i), mesh.node[n].y + u(i + 1), mesh.node[n].z + u(i + 2)};
      }
      EXPECT_NEAR(static_cast<double>(block.report.volume_ratio[l]), volume(mesh) / rest, 2e-6);
    }
  }
}

TEST(Deformation, NonsenseTemplatesAreRefused) {
  const auto with = [](MuscleOptions options) {
    return make_muscle_template(*make_block({1, 1, 2}, 0.01), Material{}, options).has_value();
  };
  EXPECT_TRUE(with({}));
  for (const double bad : {-1.0, std::nan(""), 1e9}) EXPECT_FALSE(with({FarEnd::held, bad, 1, 1}));
  EXPECT_FALSE(with({FarEnd::held, 0, 2, 1}));
  EXPECT_FALSE(with({FarEnd::held, 0, 0, 1}));
  EXPECT_FALSE(with({FarEnd::held, 0, 1, std::nan("")}));
}

}  // namespace mobil::deformation_test
