// Histories of `mobil muscle` compared with CalculiX, an independent finite-element code (package calculix-ccx), with
// the same mesh, mass matrix and step.
#include "tests/lab/calculix.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/program/program.h"

namespace mobil::calculix_test {
using calculix::Block;
using calculix::History;
using calculix::Procedure;

#define NEED_CALCULIX() \
  if (!calculix::available()) GTEST_SKIP() << "CalculiX is missing: apt-get install calculix-ccx"

const Block coarse{{2, 2, 8}, 0.015, {}}, fine{{4, 4, 16}, 0.0075, {}};
const Block stubby{{3, 2, 6}, 0.012, {1060, 2.5e4, 0.45}};  // odd number across: its centre is a mean of nodes

/// Forces along (x, 0, z), N: slow growth from rest, and a short push after which the block rings.
ForceHistory slow(double x, double z) {
  return {{{0, {0, 0, 0}}, {10, {10 * x, 0, 10 * z}}}};
}
ForceHistory ringing(double x, double z) {
  return {{{0, {0, 0, 0}}, {0.02, {x, 0, z}}, {0.04, {x, 0, z}}, {0.06, {0, 0, 0}}, {10, {0, 0, 0}}}};
}

/// Returns the history that `mobil muscle` writes, without its row of t = 0.
History mobil_history(const Block& block, const ForceHistory& load, double dt_s, double seconds,
                      const std::string& options) {
  const TemporaryFolder folder;
  std::ofstream file(folder.path / "load.csv");
  file << "time_s,force_x_n,force_y_n,force_z_n\n";
  for (const auto& row : load.row) {
    file << fmt::format("{:.15g},{:.15g},{:.15g},{:.15g}\n", row.time_s, row.force_n.x, row.force_n.y, row.force_n.z);
  }
  file.close();
  const Ran ran =
      run_mobil(fmt::format("muscle --cells {}x{}x{} --cell-size {} --young {} --poisson {} --density {} --damping {} "
                            "--stiffness-damping {} --dt {} --seconds {} --load load.csv {}",
                            block.cells[0], block.cells[1], block.cells[2], block.cell_size_m, block.material.young_pa,
                            block.material.poisson, block.material.density_kg_m3, block.mass_damping_1_s,
                            block.stiffness_damping_s, dt_s, seconds, options),
                folder.path);
  if (ran.status != 0) throw std::runtime_error(ran.err);
  const Csv csv(folder.path / "disp.csv");
  History history;
  for (std::size_t r = 1; r < csv.rows.size(); ++r) {
    history.push_back({csv.number(r, "u_x_m"), csv.number(r, "u_y_m"), csv.number(r, "u_z_m")});
  }
  return history;
}

/// Returns the norm of the difference, relative to that of CalculiX's history.
double distance(const History& ours, const History& theirs) {
  EXPECT_EQ(ours.size(), theirs.size());
  double error = 0, norm = 0;
  for (std::size_t n = 0; n < std::min(ours.size(), theirs.size()); ++n) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      error += std::pow(ours[n][axis] - theirs[n][axis], 2);
      norm += std::pow(theirs[n][axis], 2);
    }
  }
  return std::sqrt(error / norm);
}

struct Case {
  const char* name;
  Block block;
  ForceHistory load;
  double dt_s, seconds;
};

Block damped(Block block, double alpha, double beta) {
  block.mass_damping_1_s = alpha;
  block.stiffness_damping_s = beta;
  return block;
}

/// Bounds. CalculiX's explicit variant differs to first order in the step (see the mean of three steps below), and its
/// damping is half a step late. The other methods solve the same equations.
constexpr double explicit_criterion = 5e-3, implicit_criterion = 1e-4;

void expect_agreement(const Case& c, Procedure procedure, const std::string& options) {
  const auto theirs = calculix::run(c.block, c.load, procedure, c.dt_s, c.seconds);
  for (const std::string precision : {"single", "double"}) {
    const auto ours =
        mobil_history(c.block, c.load, c.dt_s, c.seconds, fmt::format("{} --precision {}", options, precision));
    EXPECT_LT(distance(ours, theirs),
              procedure == Procedure::explicit_dynamics ? explicit_criterion : implicit_criterion)
        << c.name << ", " << options << ", " << precision;
  }
}

TEST(Calculix, StaticSolutions) {
  NEED_CALCULIX();
  for (const Block& block : {coarse, fine, stubby}) {
    for (const auto& load : {slow(0.002, 0), slow(0, 0.02)}) {
      expect_agreement({"at the end of a ramp", block, load, 1, 1}, Procedure::statics, "--method static");
    }
  }
}

TEST(Calculix, ExplicitCentralDifferences) {
  NEED_CALCULIX();
  const std::vector<Case> cases = {
      {"2x2x8 slow, axial", coarse, slow(0, 0.02), 1e-3, 0.6},
      {"2x2x8 slow, lateral", coarse, slow(0.002, 0), 2e-3, 1},
      {"2x2x8 ringing, axial", coarse, ringing(0, 0.02), 1e-3, 0.6},
      {"2x2x8 ringing, lateral", coarse, ringing(0.002, 0), 2e-3, 1},
      {"2x2x8 ringing, damped", damped(coarse, 3, 0), ringing(0.002, 0.01), 5e-4, 0.4},
      {"3x2x6 ringing, both ways", stubby, ringing(0.01, 0.05), 3e-4, 0.15},
      {"3x2x6 slow, damped", damped(stubby, 5, 0), slow(0.01, 0.05), 5e-4, 0.2},
      {"4x4x16 ringing, both ways", fine, ringing(0.002, 0.01), 1e-3, 0.2},
      {"4x4x16 slow, lateral", fine, slow(0.002, 0), 1.2e-3, 0.24},
  };
  for (const Case& c : cases) expect_agreement(c, Procedure::explicit_dynamics, "--method explicit-central");
}

TEST(Calculix, ItsExplicitVariantPrintsAMeanOfThreeOfOurSteps) {
  NEED_CALCULIX();
  // The explicit form of Newmark's method with β = 1/4 evaluates its forces at a predicted ũ, which is the result of
  // central differences, and prints u = ũ + ¼Δt²·a = (ũ₋₁ + 2ũ + ũ₊₁)/4. Near the critical step the difference is
  // large.
  const double dt = 2.8e-3;
  const auto load = ringing(0.001, 0.02);
  const auto theirs = calculix::run(coarse, load, Procedure::explicit_dynamics, dt, 200 * dt);
  const auto ours = mobil_history(coarse, load, dt, 201 * dt, "--method explicit-central --precision double");
  ASSERT_EQ(ours.size(), theirs.size() + 1);
  History mean;
  for (std::size_t n = 0; n < theirs.size(); ++n) {
    mean.push_back({});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      mean[n][axis] = ((n > 0 ? ours[n - 1][axis] : 0) + 2 * ours[n][axis] + ours[n + 1][axis]) / 4;
    }
  }
  EXPECT_LT(distance(mean, theirs), 1e-4);
}

TEST(Calculix, ConstantAverageAcceleration) {
  NEED_CALCULIX();
  const std::vector<Case> cases = {
      {"2x2x8 slow, axial", coarse, slow(0, 0.02), 4e-3, 0.6},
      {"2x2x8 slow, lateral", coarse, slow(0.002, 0), 4e-3, 0.6},
      {"2x2x8 ringing, axial", coarse, ringing(0, 0.02), 4e-3, 0.8},
      {"2x2x8 ringing, lateral", coarse, ringing(0.002, 0), 5e-3, 1},
      {"2x2x8 ringing, damped by mass", damped(coarse, 8, 0), ringing(0.002, 0.01), 4e-3, 0.6},
      {"2x2x8 ringing, damped by both", damped(coarse, 2, 2e-3), ringing(0.002, 0.01), 4e-3, 0.6},
      {"3x2x6 ringing, both ways", stubby, ringing(0.01, 0.05), 2e-3, 0.2},
      {"3x2x6 slow, damped by stiffness", damped(stubby, 0, 1e-3), slow(0.01, 0.05), 2e-3, 0.2},
      {"4x4x16 ringing, both ways", fine, ringing(0.002, 0.01), 5e-3, 0.25},
  };
  for (const Case& c : cases) expect_agreement(c, Procedure::implicit_dynamics, "--method newmark --mass consistent");
}

}  // namespace mobil::calculix_test
