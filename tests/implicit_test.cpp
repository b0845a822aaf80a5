// The implicit methods' sixteen-lane kernels against a dense double-precision model, and what must hold of each method.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "assets/belly_solver.h"
#include "systems/deformation/deformation.h"
#include "tests/oracle.h"

namespace mobil {
namespace {

using oracle::Matrix;
using oracle::Vector;

constexpr float tick_s = 1.0F / 60.0F;

HexahedralMesh spindle(const Cells& cells) {
  const std::vector<CageStation> stations = {
      {0, 0, 0, 0.012F, 0.014F}, {0.5F, 0.006F, -0.004F, 0.021F, 0.018F}, {1, 0, 0, 0.011F, 0.01F}};
  return *bend_block(cells, stations, 0.12);
}

MuscleTemplate make(HexahedralMesh mesh, const MuscleOptions& options) {
  auto made = make_muscle_template(std::move(mesh), Material{}, options);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

BellySolver make_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s, double across = 1,
                        double along = 1) {
  auto made = make_belly_solver(muscle, method, mass, dt_s, across, along);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

/// Anything that can drive a far face, and the frame: the same for the kernel and the oracle.
struct Drive {
  EndDisplacement<Lanes<float>> displacement{};
  EndForce<Lanes<float>> force{};
  EndTraction<Lanes<float>> traction{};
  FrameLoad<Lanes<float>> frame{};
  bool framed = false;

  EndDrive of(FarEnd end) const {
    return end == FarEnd::held ? EndDrive(displacement) : end == FarEnd::sliding ? EndDrive(force) : EndDrive(traction);
  }
};

/// A smooth drive that starts from rest, other in every lane.
Drive drive_at(double t, double size, bool framed) {
  Drive drive;
  drive.framed = framed;
  const auto wave = [](double time, std::size_t lane, double phase) {
    return std::sin(7 * time + 0.3 * static_cast<double>(lane) + phase) * std::min(1.0, 5 * time);
  };
  const auto set = [&](Lanes<float>& from, Lanes<float>& to, double amount, double phase) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      from[l] = static_cast<float>(amount * wave(t, l, phase));
      to[l] = static_cast<float>(amount * wave(t + static_cast<double>(tick_s), l, phase));
    }
  };
  set(drive.displacement.from_m, drive.displacement.to_m, size * 0.012, 0);
  set(drive.force.from_n, drive.force.to_n, size * 0.3, 0);
  set(drive.traction.from_n.x, drive.traction.to_n.x, size * 0.006, 1);
  set(drive.traction.from_n.y, drive.traction.to_n.y, size * -0.004, 2);
  set(drive.traction.from_n.z, drive.traction.to_n.z, size * 0.2, 0);
  if (!framed) return drive;
  auto &a = drive.frame.constant_from, &b = drive.frame.constant_to;
  set(a.x, b.x, 3, 0.3);
  set(a.y, b.y, -2, 1.3);
  set(a.z, b.z, 9, 2.1);
  auto &g = drive.frame.gradient_from, &h = drive.frame.gradient_to;
  double phase = 0;
  for (auto row : {&Mat3<Lanes<float>>::x, &Mat3<Lanes<float>>::y, &Mat3<Lanes<float>>::z}) {
    for (auto column : {&Vec3<Lanes<float>>::x, &Vec3<Lanes<float>>::y, &Vec3<Lanes<float>>::z}) {
      set(g.*row.*column, h.*row.*column, 25, phase += 0.4);
    }
  }
  return drive;
}

/// Sixteen bellies of one template, at rest.
struct Block {
  const MuscleTemplate& muscle;
  BellySolver solver;
  Stiffness stiffness = Stiffness::individual;
  BellyScale<Lanes<float>> scale{};
  std::vector<Lanes<float>> u, v, scratch;
  BellyReport<Lanes<float>> report{};

  /// Bellies of all the sizes within the given parts of the solver's ratio and of its S·l.
  Block(const MuscleTemplate& m, BellySolver s, double ratio_spread, double size_spread)
      : muscle(m),
        solver(std::move(s)),
        u(nodal_width(m.mesh.cells)),
        v(u.size()),
        scratch(scratch_floats(m, solver.method) / lane_count) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      const double a = static_cast<double>(l % 4) / 1.5 - 1, b = static_cast<double>(l / 4) / 1.5 - 1;
      const double r = solver.across / solver.along * (1 + ratio_spread * a);
      const double size = solver.across * solver.along * (1 + size_spread * b);
      scale.across[l] = static_cast<float>(std::sqrt(r * size));
      scale.along[l] = static_cast<float>(std::sqrt(size / r));
    }
  }
  void be_all_alike() {
    stiffness = Stiffness::shared;
    for (std::size_t l = 0; l < lane_count; ++l) scale.across[l] = scale.along[l] = 1;
  }
  void tick(const Drive& drive, std::uint32_t substeps, float length_s = tick_s) {
    const BellyBlock block{
        muscle, scale, u.data()->lane, v.data()->lane, report, stiffness, drive.framed ? &drive.frame : nullptr};
    deform_implicit(block, solver, drive.of(muscle.options.far_end), substeps, length_s, scratch.data()->lane);
  }
  Vector lane(const std::vector<Lanes<float>>& column, std::size_t l) const {
    Vector x(static_cast<Eigen::Index>(column.size()));
    for (std::size_t i = 0; i < column.size(); ++i) x(static_cast<Eigen::Index>(i)) = static_cast<double>(column[i][l]);
    return x;
  }
};

/// One lane in double precision, straight from the equations of deformation.h, all matrices dense.
struct Dense {
  Method method;
  const MuscleOptions& options;
  HexahedralMesh mesh;
  Matrix mass, elastic, foundation;
  std::vector<Eigen::Index> moving;
  Vector share, u, v, before;
  double dt;
  Eigen::LDLT<Matrix> factor;

  Dense(const Block& block, std::size_t l, double step_s) : method(block.solver.method), options(block.muscle.options) {
    dt = step_s;
    mesh = oracle::scaled(block.muscle.mesh, static_cast<double>(block.scale.across[l]),
                          static_cast<double>(block.scale.along[l]));
    const auto model = oracle::assemble(mesh, block.muscle.material);
    elastic = model.stiffness;
    mass = block.solver.mass == Mass::lumped ? Matrix(model.lumped.asDiagonal()) : model.mass;
    const double circular = 2 * std::numbers::pi * options.foundation_hz;
    foundation = circular * circular * mass;
    for (Eigen::Index i = 2; i < foundation.rows(); i += 3) foundation.row(i).setZero();
    moving = oracle::free_components(mesh.cells, options.far_end);
    share = oracle::far_shares(mesh);
    u = v = before = Vector::Zero(elastic.rows());
    const double alpha = options.damping_per_s, beta = options.stiffness_damping_s;
    const Matrix what = method == Method::icd ? mass
                        : method == Method::statics
                            ? Matrix(elastic + foundation)
                            : Matrix((2 / dt + alpha) * mass + (dt / 2 + beta) * elastic + dt / 2 * foundation);
    factor.compute(what(moving, moving));
  }

  /// The loads at a fraction of the tick; of a held face its displacement along z.
  struct Moment {
    Vector force;
    double far;
  };
  Moment at(const Drive& drive, std::size_t l, double part) const {
    const auto mix = [&](const Lanes<float>& from, const Lanes<float>& to) {
      return static_cast<double>(from[l]) + part * (static_cast<double>(to[l]) - static_cast<double>(from[l]));
    };
    Vector force = Vector::Zero(u.size());
    if (drive.framed) {
      const auto& f = drive.frame;
      Vector a = force;
      using Row = Vec3<Lanes<float>>;
      const auto constant = [&](auto axis) { return mix(f.constant_from.*axis, f.constant_to.*axis); };
      for (std::size_t n = 0; n < mesh.node.size(); ++n) {
        const auto i = static_cast<Eigen::Index>(3 * n);
        const auto& p = mesh.node[n];
        const auto gradient = [&](const Row& from, const Row& to) {
          return mix(from.x, to.x) * p.x + mix(from.y, to.y) * p.y + mix(from.z, to.z) * p.z;
        };
        a(i) = constant(&Row::x) + gradient(f.gradient_from.x, f.gradient_to.x);
        a(i + 1) = constant(&Row::y) + gradient(f.gradient_from.y, f.gradient_to.y);
        a(i + 2) = constant(&Row::z) + gradient(f.gradient_from.z, f.gradient_to.z);
      }
      force = mass * a;
    }
    for (Eigen::Index n = 0; n < share.size(); ++n) {
      if (options.far_end == FarEnd::sliding) force(3 * n + 2) += share(n) * mix(drive.force.from_n, drive.force.to_n);
      if (options.far_end != FarEnd::free) continue;
      const auto &from = drive.traction.from_n, &to = drive.traction.to_n;
      force(3 * n) += share(n) * mix(from.x, to.x);
      force(3 * n + 1) += share(n) * mix(from.y, to.y);
      force(3 * n + 2) += share(n) * mix(from.z, to.z);
    }
    return {force, mix(drive.displacement.from_m, drive.displacement.to_m)};
  }
  void set_far(Vector& x, double value) const {
    if (options.far_end != FarEnd::held) return;
    for (std::uint32_t n = first_insertion_node(mesh.cells); n < node_count(mesh.cells); ++n) x(3 * n + 2) = value;
  }
  void step(const Moment& now, const Moment& next) {
    const double alpha = options.damping_per_s, beta = options.stiffness_damping_s;
    before = u;
    const auto solve = [&](const Vector& right) { return Vector(factor.solve(Vector(right(moving)))); };
    if (method == Method::statics) {
      u.setZero();
      set_far(u, next.far);
      u(moving) = solve(next.force - elastic * u);
      return;
    }
    set_far(v, (next.far - now.far) / dt);
    Vector far = Vector::Zero(u.size());
    set_far(far, (next.far - now.far) / dt);
    if (method == Method::icd) {
      const Vector right = now.force - elastic * (u + beta * v) - foundation * u - alpha * mass * far;
      v(moving) = ((1 - alpha * dt / 2) * v(moving) + dt * solve(right)) / (1 + alpha * dt / 2);
      u += dt * v;
    } else {
      const Vector right = (now.force + next.force) / 2 + 2 / dt * (mass * (v - far)) - alpha * mass * far -
                           elastic * (u + (dt / 2 + beta) * far) - foundation * u;
      far(moving) = solve(right);
      u += dt * far;
      v = 2 * far - v;
    }
    set_far(u, next.far);
  }
  std::array<double, 4> report() const {
    const Vector inner = elastic * u;
    double reaction = 0, elongation = 0;
    for (std::uint32_t n = first_insertion_node(mesh.cells); n < node_count(mesh.cells); ++n) {
      reaction += inner(3 * n + 2);
      elongation += share(n) * u(3 * n + 2);
    }
    const double kinetic = method == Method::statics ? 0 : 0.5 * v.dot(mass * v);
    return {reaction, elongation, kinetic, 0.5 * (method == Method::icd ? before : u).dot(inner)};
  }
};

struct Distance {
  double displacement = 0, report = 0;  // worst lane's, relative to the norm of the history
};

Distance distance_from_oracle(Block& block, bool framed, int ticks, std::uint32_t substeps) {
  std::vector<Dense> model;
  for (std::size_t l = 0; l < lane_count; ++l) model.emplace_back(block, l, static_cast<double>(tick_s) / substeps);
  std::vector<std::array<double, 5>> error(lane_count), norm(lane_count);
  for (int tick = 0; tick < ticks; ++tick) {
    const Drive drive = drive_at(tick * static_cast<double>(tick_s), 1, framed);
    block.tick(drive, substeps);
    for (std::size_t l = 0; l < lane_count; ++l) {
      Dense& dense = model[l];
      for (std::uint32_t s = 0; s < (block.solver.method == Method::statics ? 1 : substeps); ++s) {
        const double count = block.solver.method == Method::statics ? 1 : substeps;
        dense.step(dense.at(drive, l, s / count), dense.at(drive, l, (s + 1) / count));
      }
      error[l][0] += (block.lane(block.u, l) - dense.u).squaredNorm();
      norm[l][0] += dense.u.squaredNorm();
      const auto expected = dense.report();
      const float got[4] = {block.report.reaction_n[l], block.report.elongation_m[l], block.report.kinetic_energy_j[l],
                            block.report.strain_energy_j[l]};
      for (std::size_t q = 0; q < 4; ++q) {
        error[l][q + 1] += std::pow(static_cast<double>(got[q]) - expected[q], 2);
        norm[l][q + 1] += std::pow(expected[q], 2);
      }
    }
  }
  Distance worst;
  const auto relative = [](double e, double n) { return std::sqrt(e / std::max(n, 1e-30)); };
  for (std::size_t l = 0; l < lane_count; ++l) {
    worst.displacement = std::max(worst.displacement, relative(error[l][0], norm[l][0]));
    for (std::size_t q = 1; q < 5; ++q) worst.report = std::max(worst.report, relative(error[l][q], norm[l][q]));
  }
  return worst;
}

/// Smallest stable number of central-difference substeps of all lanes with the consistent mass.
std::uint32_t icd_substeps(const Block& block) {
  double top = 0;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Dense dense(block, l, 1e-3);
    const Matrix k = (dense.elastic + dense.foundation)(dense.moving, dense.moving),
                 m = dense.mass(dense.moving, dense.moving);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(k, m, Eigen::EigenvaluesOnly);
    top = std::max(top, solver.eigenvalues().maxCoeff());
  }
  const double xi = block.muscle.options.stiffness_damping_s * std::sqrt(top) / 2;
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
      const std::uint32_t n = method == Method::icd ? icd_substeps(block) : 1;
      const Distance distance = distance_from_oracle(block, p.framed, ticks, n);
      const std::string where = std::string(far_end_name[static_cast<std::size_t>(end)]) + ", alpha " +
                                std::to_string(p.alpha) + ", beta " + std::to_string(p.beta) + ", foundation " +
                                std::to_string(p.foundation_hz) + (p.framed ? ", framed" : "");
      const double swept = method == Method::caa && !alike ? 3 : 1;
      EXPECT_LT(distance.displacement, swept * 1e-4) << where;
      EXPECT_LT(distance.report, swept * 4e-4) << where;
    }
  }
}

TEST(Implicit, MeanAccelerationOfOneBodyFollowsTheDenseModel) {
  follows(Method::caa, Mass::lumped, true, {2, 2, 8}, 12);
  follows(Method::caa, Mass::consistent, true, {2, 1, 4}, 60);
}

TEST(Implicit, MeanAccelerationOfIndividualsFollowsTheDenseModel) {
  follows(Method::caa, Mass::lumped, false, {2, 2, 8}, 12);
  follows(Method::caa, Mass::consistent, false, {2, 1, 4}, 60);
}

TEST(Implicit, CentralDifferencesWithConsistentMassFollowTheDenseModel) {
  follows(Method::icd, Mass::consistent, false, {2, 1, 4}, 30);
  follows(Method::icd, Mass::consistent, true, {1, 2, 3}, 30);
}

TEST(Implicit, StaticAnswersFollowTheDenseModel) {
  follows(Method::statics, Mass::lumped, false, {2, 2, 8}, 5);
  follows(Method::statics, Mass::consistent, false, {2, 1, 4}, 5);
  follows(Method::statics, Mass::lumped, true, {2, 2, 8}, 5);
}

TEST(Implicit, SolverForAnotherBodyServesThoseAboutIt) {
  const MuscleTemplate muscle = make(spindle({1, 2, 4}), {FarEnd::free, 2});
  for (const Method method : {Method::caa, Method::statics}) {
    Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s), 1.3, 0.9), 0.06, 0.12);
    EXPECT_LT(distance_from_oracle(block, true, 20, 1).displacement, 1e-4);
  }
}

TEST(Implicit, MoreSweepsComeCloserInEveryMethodThatSweeps) {
  const MuscleTemplate muscle = make(spindle({2, 2, 4}), {FarEnd::free, 2});
  for (const Method method : {Method::caa, Method::statics}) {
    std::vector<double> distance;
    for (const std::uint32_t sweeps : {2, 4, 6}) {
      Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s)), 0.12, 0.25);
      block.solver.sweeps = sweeps;
      distance.push_back(distance_from_oracle(block, false, 20, 1).displacement);
    }
    EXPECT_LT(distance[1], 0.2 * distance[0]);
    EXPECT_LT(distance[2], std::max(0.2 * distance[1], 5e-5));
  }
}

TEST(Implicit, OneLayerOfElementsMovesOrIsHeldWhole) {
  for (const FarEnd end : far_ends) {
    const MuscleTemplate muscle = make(*make_block({1, 1, 1}, 0.02), {end, 3});
    for (const Method method : {Method::caa, Method::statics}) {
      Block block(muscle, make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s)), 0.05, 0.1);
      EXPECT_LT(distance_from_oracle(block, true, 20, 1).displacement, 1e-4);
    }
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

double energy(const Block& block, std::size_t l) {
  return static_cast<double>(block.report.kinetic_energy_j[l]) + static_cast<double>(block.report.strain_energy_j[l]);
}

double largest(const Block& block) {
  double most = 0;
  for (const auto& lanes : block.u) {
    for (const float x : lanes.lane) most = std::isfinite(x) ? std::max(most, std::abs(double{x})) : INFINITY;
  }
  return most;
}

TEST(Implicit, FreeUndampedMotionKeepsItsEnergy) {
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    for (const bool alike : {true, false}) {
      const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::free, 0});
      Block block(muscle, make_solver(muscle, Method::caa, mass, static_cast<double>(tick_s)), 0.06, 0.12);
      block.solver.sweeps = 5;
      if (alike) block.be_all_alike();
      shake(block, 0.002F);
      block.tick(Drive{}, 1);
      std::vector<double> first(lane_count);
      for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(block, l);
      for (int tick = 0; tick < 300; ++tick) block.tick(Drive{}, 1);
      for (std::size_t l = 0; l < lane_count; ++l) EXPECT_NEAR(energy(block, l) / first[l], 1, 5e-5) << "lane " << l;
    }
  }
}

TEST(Implicit, MeanAccelerationIsStableAtAnyStepAndCentralDifferencesAreNot) {
  for (const float length_s : {tick_s, 1.0F}) {
    const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::free, 0});
    Block block(muscle, make_solver(muscle, Method::caa, Mass::lumped, static_cast<double>(length_s)), 0.06, 0.12);
    shake(block, 0.001F);
    for (int tick = 0; tick < 1000; ++tick) block.tick(Drive{}, 1, length_s);
    EXPECT_LT(largest(block), 0.1);

    Block lost(muscle, make_solver(muscle, Method::icd, Mass::consistent, static_cast<double>(length_s)), 0, 0);
    shake(lost, 0.001F);
    for (int tick = 0; tick < 40; ++tick) lost.tick(Drive{}, 1, length_s);
    EXPECT_GT(largest(lost), 1e6);
  }
}

TEST(Implicit, CentralDifferencesWithConsistentMassKeepTheirEnergyAndReachTheirLimit) {
  const MuscleTemplate muscle = make(spindle({2, 2, 4}), {FarEnd::free, 0});
  Block block(muscle, make_solver(muscle, Method::icd, Mass::consistent, static_cast<double>(tick_s)), 0.2, 0.2);
  shake(block, 0.001F);
  const std::uint32_t n = icd_substeps(block);
  block.tick(Drive{}, n);
  std::vector<double> first(lane_count);
  for (std::size_t l = 0; l < lane_count; ++l) first[l] = energy(block, l);
  for (int tick = 0; tick < 300; ++tick) block.tick(Drive{}, n);
  for (std::size_t l = 0; l < lane_count; ++l) EXPECT_NEAR(energy(block, l) / first[l], 1, 5e-5) << "lane " << l;
}

TEST(Implicit, SlenderBelliesBendToTheStaticAnswer) {
  for (const bool alike : {true, false}) {
    const MuscleTemplate muscle = make(*make_block({1, 1, 12}, 0.004), {FarEnd::free, 0});  // condition 1.3e5
    Block block(muscle, make_solver(muscle, Method::statics, Mass::lumped, 0), 0.06, 0.12);
    if (alike) block.be_all_alike();
    EXPECT_LT(distance_from_oracle(block, false, 10, 1).displacement, 1e-3);
  }
}

TEST(Implicit, RestStaysAtRest) {
  for (const Method method : {Method::caa, Method::icd, Method::statics}) {
    const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::held, 8});
    Block block(muscle, make_solver(muscle, method, Mass::consistent, static_cast<double>(tick_s)), 0.06, 0.12);
    for (int tick = 0; tick < 3; ++tick) block.tick(Drive{}, 8);
    for (const auto& column : {block.u, block.v}) {
      for (const auto& lanes : column) {
        for (const float x : lanes.lane) ASSERT_EQ(x, 0.0F);
      }
    }
  }
}

bool same_bits(const std::vector<Lanes<float>>& a, const std::vector<Lanes<float>>& b, std::size_t but_lane) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      if (l != but_lane && std::memcmp(&a[i].lane[l], &b[i].lane[l], sizeof(float)) != 0) return false;
    }
  }
  return true;
}

TEST(Implicit, NotANumberStaysInItsLane) {
  for (const Method method : {Method::caa, Method::icd, Method::statics}) {
    for (const FarEnd end : far_ends) {
      const MuscleTemplate muscle = make(spindle({2, 2, 4}), {end, 8});
      const BellySolver solver = make_solver(muscle, method, Mass::consistent, static_cast<double>(tick_s));
      for (const std::size_t sick : {std::size_t{0}, std::size_t{11}}) {
        Block clean(muscle, solver, 0.06, 0.12), dirty(muscle, solver, 0.06, 0.12);
        for (auto& lanes : dirty.scratch) {
          for (float& x : lanes.lane) x = std::numeric_limits<float>::quiet_NaN();  // whatever was there before
        }
        for (int tick = 0; tick < 6; ++tick) {
          Drive drive = drive_at(tick * static_cast<double>(tick_s), 1, true);
          clean.tick(drive, method == Method::icd ? 16 : 1);
          if (tick == 1) drive.frame.constant_to.x[sick] = std::numeric_limits<float>::quiet_NaN();
          if (tick == 1) drive.displacement.to_m[sick] = INFINITY;
          if (tick == 3) dirty.scale.across[sick] = INFINITY;
          dirty.tick(drive, method == Method::icd ? 16 : 1);
        }
        EXPECT_TRUE(same_bits(clean.u, dirty.u, sick));
        EXPECT_TRUE(same_bits(clean.v, dirty.v, sick));
        EXPECT_FALSE(std::isfinite(dirty.u[3 * 9 + 2][sick]));
        for (std::size_t l = 0; l < lane_count; ++l) {
          EXPECT_TRUE(l == sick || clean.report.strain_energy_j[l] == dirty.report.strain_energy_j[l]) << "lane " << l;
        }
      }
    }
  }
}

TEST(Implicit, SameBitsInEveryLaneAndOnEveryInstructionSetWithFusedMultiplyAdd) {
  for (const Method method : {Method::caa, Method::icd, Method::statics}) {
    const MuscleTemplate muscle = make(spindle({2, 2, 8}), {FarEnd::sliding, 8});
    const BellySolver solver = make_solver(muscle, method, Mass::lumped, static_cast<double>(tick_s));
    std::vector<Block> results;
    for (const std::int64_t target : {std::int64_t{HWY_AVX2}, std::int64_t{HWY_AVX3}, std::int64_t{HWY_NEON}}) {
      if ((hwy::SupportedTargets() & target) == 0) continue;
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
      Block block(muscle, solver, 0, 0);
      for (std::size_t l = 0; l < lane_count; ++l) {
        block.scale.across[l] = 1.02F;
        block.scale.along[l] = 0.98F;
      }
      for (int tick = 0; tick < 20; ++tick) {
        Drive drive = drive_at(tick * static_cast<double>(tick_s), 1, false);
        for (std::size_t l = 1; l < lane_count; ++l) {
          drive.force.from_n[l] = drive.force.from_n[0];
          drive.force.to_n[l] = drive.force.to_n[0];
        }
        block.tick(drive, method == Method::icd ? 16 : 1);
      }
      results.push_back(block);
      hwy::SetSupportedTargetsForTest(0);
      hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
    if (results.empty()) GTEST_SKIP() << "no instruction set with fused multiply-add here";
    for (const Block& block : results) {
      EXPECT_TRUE(same_bits(block.u, results.front().u, lane_count));
      for (const auto& lanes : block.u) {
        for (const float x : lanes.lane) EXPECT_EQ(x, lanes[0]);
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
  EXPECT_FALSE(refused(Method::caa, 0.01));
  EXPECT_FALSE(refused(Method::statics, -1));
  EXPECT_TRUE(refused(Method::ecd, 0.01));
  for (const double bad : {0.0, -0.01, 1e9, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    EXPECT_TRUE(refused(Method::caa, bad));
    EXPECT_TRUE(refused(Method::icd, bad));
    EXPECT_TRUE(refused(Method::caa, 0.01, bad, bad));
  }
  EXPECT_TRUE(refused(Method::caa, 0.01, 3, 1));
  EXPECT_TRUE(refused(Method::caa, 0.01, 1, 3));
  const auto wide = make(*make_block({40, 40, 2}, 0.01), {FarEnd::free, 0, 1, 1});
  EXPECT_FALSE(make_belly_solver(wide, Method::caa, Mass::lumped, 0.01).has_value());
}

}  // namespace
}  // namespace mobil
