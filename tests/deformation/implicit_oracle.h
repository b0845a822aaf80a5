#pragma once
// Sixteen bellies stepped implicitly, and each of them once more in double precision with dense matrices.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "engine/eigen.h"
#include "systems/deformation/deformation.h"
#include "tests/fem/oracle.h"
#include "tests/fem/spindle.h"

namespace mobil::oracle {

inline constexpr float tick_s = 1.0F / 60.0F;

inline MuscleTemplate make(HexahedralMesh mesh, const MuscleOptions& options) {
  auto made = make_muscle_template(std::move(mesh), Material{}, options);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

inline BellySolver make_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s, double across = 1,
                               double along = 1) {
  auto made = make_belly_solver(muscle, method, mass, dt_s, across, along);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

/// Anything that can drive a far face, and the frame: the same for the kernel and the oracle.
struct Drive {
  EndDrive<Lanes<float>> displacement{}, force{};
  EndTraction<Lanes<float>> traction{};
  FrameLoad<Lanes<float>> frame{};
  bool framed = false;

  FarFaceDrive of(FarEnd end) const {
    if (end == FarEnd::free) return traction;
    return {end, end == FarEnd::held ? displacement : force};
  }
};

/// A smooth drive that starts from rest, other in every lane.
inline Drive drive_at(double t, double size, bool framed) {
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
  set(drive.displacement.from, drive.displacement.to, size * 0.012, 0);
  set(drive.force.from, drive.force.to, size * 0.3, 0);
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
      if (options.far_end == FarEnd::sliding) force(3 * n + 2) += share(n) * mix(drive.force.from, drive.force.to);
      if (options.far_end != FarEnd::free) continue;
      const auto &from = drive.traction.from_n, &to = drive.traction.to_n;
      force(3 * n) += share(n) * mix(from.x, to.x);
      force(3 * n + 1) += share(n) * mix(from.y, to.y);
      force(3 * n + 2) += share(n) * mix(from.z, to.z);
    }
    return {force, mix(drive.displacement.from, drive.displacement.to)};
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

inline Distance distance_from_oracle(Block& block, bool framed, int ticks, std::uint32_t substeps) {
  std::vector<Dense> model;
  for (std::size_t l = 0; l < lane_count; ++l) model.emplace_back(block, l, static_cast<double>(tick_s) / substeps);
  std::vector<std::array<double, 5>> error(lane_count), norm(lane_count);
  for (int tick = 0; tick < ticks; ++tick) {
    const Drive drive = drive_at(tick * static_cast<double>(tick_s), 1, framed);
    block.tick(drive, substeps);
    for (std::size_t l = 0; l < lane_count; ++l) {
      Dense& belly = model[l];
      for (std::uint32_t s = 0; s < (block.solver.method == Method::statics ? 1 : substeps); ++s) {
        const double count = block.solver.method == Method::statics ? 1 : substeps;
        belly.step(belly.at(drive, l, s / count), belly.at(drive, l, (s + 1) / count));
      }
      error[l][0] += (block.lane(block.u, l) - belly.u).squaredNorm();
      norm[l][0] += belly.u.squaredNorm();
      const auto expected = belly.report();
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

}  // namespace mobil::oracle
