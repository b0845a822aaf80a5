// The sixteen-lane kernel against a dense double-precision model, and what must hold of any such kernel.
#include "systems/deformation/deformation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "assets/fem/muscle_template.h"
#include "tests/engine/instruction_sets.h"
#include "tests/fem/oracle.h"
#include "tests/fem/spindle.h"

namespace mobil::deformation_test {
using oracle::Vector;

constexpr float tick_s = 1.0F / 60.0F;

MuscleTemplate make(HexahedralMesh mesh, FarEnd end, double damping) {
  auto made = make_muscle_template(std::move(mesh), Material{}, {end, damping, 0.25, 4});
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

/// Sixteen bellies of one template, at rest, of sixteen sizes.
struct Block {
  MuscleTemplate muscle;
  Stiffness stiffness = Stiffness::individual;
  BellyScale<Lanes<float>> scale{};
  std::vector<Lanes<float>> u, v;
  BellyReport<Lanes<float>> report{};

  explicit Block(MuscleTemplate m)
      : muscle(std::move(m)), u(nodal_width(muscle.mesh.cells)), v(nodal_width(muscle.mesh.cells)) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      scale.across[l] = 0.75F + 0.05F * static_cast<float>(l);
      scale.along[l] = 1.3F - 0.03F * static_cast<float>((5 * l) % lane_count);
    }
  }
  void be_all_alike() {
    stiffness = Stiffness::shared;
    for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
  }
  std::uint32_t substeps() const {
    std::uint32_t most = 1;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const auto limit = critical_step(muscle.critical_steps, scale.across[l], scale.along[l]);
      most = std::max(most, substeps_within(limit.value(), tick_s));
    }
    return most;
  }
  template <class End>
  void tick(const End& end, std::uint32_t n, float length_s = tick_s) {
    deform_explicit({muscle, scale, u.data()->lane, v.data()->lane, report, stiffness}, end, n, length_s);
  }
  Vector lane(const std::vector<Lanes<float>>& column, std::size_t l) const {
    Vector x(static_cast<Eigen::Index>(column.size()));
    for (std::size_t i = 0; i < column.size(); ++i) x(static_cast<Eigen::Index>(i)) = static_cast<double>(column[i][l]);
    return x;
  }
  oracle::Model model(std::size_t l) const {
    return oracle::assemble(
        oracle::scaled(muscle.mesh, static_cast<double>(scale.across[l]), static_cast<double>(scale.along[l])),
        muscle.material);
  }
};

/// A far end with the way it is driven.
template <FarEnd way>
struct DrivenEnd : EndDrive<Lanes<float>> {
  operator FarFaceDrive() const { return {way, *this}; }  // NOLINT(google-explicit-constructor)
};
using HeldEnd = DrivenEnd<FarEnd::held>;
using SlidingEnd = DrivenEnd<FarEnd::sliding>;

double drive(double t, std::size_t lane) {
  return std::sin(7 * t + 0.3 * static_cast<double>(lane)) * std::min(1.0, 5 * t);
}

template <class End>
void set_drive(End& end, double t, double size) {
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto from = static_cast<float>(size * drive(t, l));
    const auto to = static_cast<float>(size * drive(t + static_cast<double>(tick_s), l));
    if constexpr (requires { end.from; }) {
      end.from[l] = from;
      end.to[l] = to;
    } else {
      end.from_n.x[l] = 0.1F * to;
      end.to_n.x[l] = 0.1F * from;
      end.from_n.y[l] = -0.05F * from;
      end.to_n.y[l] = -0.05F * to;
      end.from_n.z[l] = from;
      end.to_n.z[l] = to;
    }
  }
}

/// Largest relative difference (norm of the history of all displacements) of any lane from the oracle over a second;
/// energies and reaction are compared at the end of every tick.
template <class End>
double distance_from_oracle(Block& block, double size) {
  const Cells& cells = block.muscle.mesh.cells;
  const FarEnd far_end = block.muscle.options.far_end;
  const auto moving = oracle::free_components(cells, far_end);
  const Vector share = oracle::far_shares(block.muscle.mesh);
  std::vector<oracle::Belly> bellies;
  for (std::size_t l = 0; l < lane_count; ++l) {
    bellies.emplace_back(block.model(l), moving, block.muscle.options.damping_per_s);
  }
  const std::uint32_t n = block.substeps();
  const double dt = static_cast<double>(tick_s) / n;
  std::vector<double> error(lane_count), norm(lane_count);
  std::vector<std::array<double, 4>> report_error(lane_count), report_norm(lane_count);
  for (int tick = 0; tick < 60; ++tick) {
    End end{};
    set_drive(end, tick * static_cast<double>(tick_s), size);
    block.tick(end, n);
    for (std::size_t l = 0; l < lane_count; ++l) {
      auto& belly = bellies[l];
      const auto value = [l](const Lanes<float>& lanes) { return static_cast<double>(lanes[l]); };
      const auto mix = [&](const Lanes<float>& a, const Lanes<float>& b, double s) {
        return value(a) + s * (value(b) - value(a));
      };
      for (std::uint32_t s = 0; s < n; ++s) {
        Vector f = Vector::Zero(belly.now.size());
        const double part = static_cast<double>(s) / n;
        if constexpr (requires { end.from_n; }) {
          for (Eigen::Index i = 0; i < share.size(); ++i) {
            f(3 * i) = share(i) * mix(end.from_n.x, end.to_n.x, part);
            f(3 * i + 1) = share(i) * mix(end.from_n.y, end.to_n.y, part);
            f(3 * i + 2) = share(i) * mix(end.from_n.z, end.to_n.z, part);
          }
        } else if constexpr (std::is_same_v<End, SlidingEnd>) {
          for (Eigen::Index i = 0; i < share.size(); ++i) f(3 * i + 2) = share(i) * mix(end.from, end.to, part);
        }
        belly.step(f, dt);
        if constexpr (std::is_same_v<End, HeldEnd>) {
          for (std::uint32_t node = first_insertion_node(cells); node < node_count(cells); ++node) {
            belly.now(3 * node + 2) = mix(end.from, end.to, (s + 1.0) / n);
          }
        }
      }
      error[l] += (block.lane(block.u, l) - belly.now).squaredNorm();
      norm[l] += belly.now.squaredNorm();
      const Vector inner = belly.model.stiffness * belly.now;
      double reaction = 0, elongation = 0;
      for (std::uint32_t node = first_insertion_node(cells); node < node_count(cells); ++node) {
        reaction += inner(3 * node + 2);
        elongation += share(node) * belly.now(3 * node + 2);
      }
      const Vector velocity = (belly.now - belly.before) / dt;
      const double kinetic = 0.5 * velocity.dot(belly.model.lumped.cwiseProduct(velocity));
      const double strain = 0.5 * belly.before.dot(inner);
      const double expected[4] = {reaction, kinetic, strain, elongation};
      const float reported[4] = {block.report.reaction_n[l], block.report.kinetic_energy_j[l],
                                 block.report.strain_energy_j[l], block.report.elongation_m[l]};
      for (std::size_t q = 0; q < 4; ++q) {
        report_error[l][q] += std::pow(static_cast<double>(reported[q]) - expected[q], 2);
        report_norm[l][q] += std::pow(expected[q], 2);
      }
    }
  }
  double worst = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    worst = std::max(worst, std::sqrt(error[l] / norm[l]));
    for (std::size_t q = 0; q < 4; ++q) {
      EXPECT_LT(std::sqrt(report_error[l][q] / report_norm[l][q]), 2e-4) << "report " << q << " of lane " << l;
    }
  }
  return worst;
}

TEST(Deformation, DrivenByDisplacementFollowsTheDenseModel) {
  Block block(make(spindle({2, 2, 8}), FarEnd::held, 8));
  EXPECT_LT(distance_from_oracle<HeldEnd>(block, 0.015), 3e-5);
}

TEST(Deformation, DrivenByForceFollowsTheDenseModel) {
  Block block(make(spindle({2, 2, 8}), FarEnd::sliding, 8));
  EXPECT_LT(distance_from_oracle<SlidingEnd>(block, 0.5), 3e-5);
}

TEST(Deformation, DrivenByTractionFollowsTheDenseModel) {
  Block block(make(spindle({2, 2, 8}), FarEnd::free, 8));
  EXPECT_LT(distance_from_oracle<EndTraction<Lanes<float>>>(block, 0.2), 3e-5);
}

TEST(Deformation, SharedStiffnessFollowsTheDenseModelInAllThreeWays) {
  Block held(make(spindle({2, 2, 8}), FarEnd::held, 0)), sliding(make(spindle({2, 2, 8}), FarEnd::sliding, 0)),
      free(make(spindle({2, 2, 8}), FarEnd::free, 0));
  for (Block* block : {&held, &sliding, &free}) block->be_all_alike();
  EXPECT_LT(distance_from_oracle<HeldEnd>(held, 0.015), 3e-5);
  EXPECT_LT(distance_from_oracle<SlidingEnd>(sliding, 0.5), 3e-5);
  EXPECT_LT(distance_from_oracle<EndTraction<Lanes<float>>>(free, 0.2), 3e-5);
}

// The longer its elements are, the closer a belly's softness comes to what rounding leaves.
TEST(Deformation, OtherMeshesFollowTheDenseModel) {
  for (const Cells& cells : {Cells{1, 1, 1}, Cells{1, 3, 2}, Cells{4, 2, 3}}) {
    Block free(make(spindle(cells), FarEnd::free, 2)), held(make(spindle(cells), FarEnd::held, 2));
    EXPECT_LT(distance_from_oracle<EndTraction<Lanes<float>>>(free, 0.1), 1e-4);
    EXPECT_LT(distance_from_oracle<HeldEnd>(held, 0.01), 3e-5);
  }
}

void shake(Block& block, float size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> any(-size, size);
  const Cells& cells = block.muscle.mesh.cells;
  for (std::uint32_t n = plane_nodes(cells); n < node_count(cells); ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t l = 0; l < lane_count; ++l) {
        const float value = any(random);
        if (moves(cells, block.muscle.options.far_end, n, c)) block.u[3 * n + c][l] = value;
      }
    }
  }
}

TEST(Deformation, FreeUndampedMotionKeepsItsEnergy) {
  Block block(make(spindle({2, 2, 8}), FarEnd::free, 0));
  shake(block, 0.002F);
  const auto n = block.substeps();
  block.tick(EndTraction<Lanes<float>>{}, n);
  const auto energy = [&](std::size_t l) {
    return static_cast<double>(block.report.kinetic_energy_j[l]) + static_cast<double>(block.report.strain_energy_j[l]);
  };
  std::vector<double> first(lane_count);
  for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(l);
  double lowest_share = 1;
  for (int tick = 0; tick < 300; ++tick) {
    block.tick(EndTraction<Lanes<float>>{}, n);
    for (std::size_t l = 0; l < lane_count; ++l) {
      ASSERT_NEAR(energy(l) / first[l], 1, 2e-5) << "lane " << l << " tick " << tick;
      lowest_share = std::min(lowest_share, static_cast<double>(block.report.kinetic_energy_j[l]) / first[l]);
    }
  }
  EXPECT_LT(lowest_share, 0.4);  // it does move to and fro between the two
}

TEST(Deformation, StableAtTheLimitAndLostJustAboveIt) {
  for (const bool above : {false, true}) {
    Block block(make(spindle({2, 2, 8}), FarEnd::free, 0));
    for (std::size_t l = 0; l < lane_count; ++l) {
      block.scale.across[l] = 1.2F;
      block.scale.along[l] = 0.9F;
    }
    shake(block, 1e-3F);
    const double limit =
        critical_step(block.muscle.terms, static_cast<double>(1.2F), static_cast<double>(0.9F), FarEnd::free);
    const double exact =
        2 / oracle::highest_frequency(block.model(0), oracle::free_components({2, 2, 8}, FarEnd::free));
    const auto dt = static_cast<float>(above ? 1.005 * exact : limit);
    for (int step = 0; step < 3000; ++step) block.tick(EndTraction<Lanes<float>>{}, 1, dt);
    double largest = 0;
    for (const auto& lanes : block.u) {
      for (const float x : lanes.lane) largest = std::isfinite(x) ? std::max(largest, std::abs(double{x})) : INFINITY;
    }
    if (above) {
      EXPECT_GT(largest, 1e6);
    } else {
      EXPECT_LT(largest, 0.5);  // a mode at the very limit may beat, not grow
      EXPECT_GT(largest, 1e-5);
    }
  }
}

TEST(Deformation, VolumeIsThatOfTheDeformedMesh) {
  for (const auto end : {FarEnd::held, FarEnd::free}) {
    Block block(make(spindle({3, 2, 5}), end, 0));
    shake(block, 0.002F);
    constexpr float instant = 1e-9F;
    if (end == FarEnd::held) {
      HeldEnd stretch{};
      for (std::size_t l = 0; l < lane_count; ++l) stretch.from[l] = stretch.to[l] = 0.01F;
      block.tick(stretch, 1, instant);
    } else {
      block.tick(EndTraction<Lanes<float>>{}, 1, instant);
    }
    for (std::size_t l = 0; l < lane_count; ++l) {
      auto mesh = oracle::scaled(block.muscle.mesh, static_cast<double>(block.scale.across[l]),
                                 static_cast<double>(block.scale.along[l]));
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
