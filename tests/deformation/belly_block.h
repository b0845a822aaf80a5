#pragma once
// Sixteen bellies stepped by any method, each of them compared with the same belly in double precision.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "demo/lab/reference/reference.h"
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

/// Returns a solver. Explicit central differences solve no system, so theirs holds only the method.
inline BellySolver make_solver(const MuscleTemplate& muscle, Method method, Mass mass, double dt_s, double across = 1,
                               double along = 1) {
  if (method == Method::explicit_central) {
    BellySolver none;
    none.method = method;
    return none;
  }
  auto made = make_belly_solver(muscle, method, mass, dt_s, across, along);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

/// All loads of a far face, and the frame, for the kernel and the reference.
struct EndPull {
  EndDrive<Lanes<float>> displacement{}, force{};
  EndTraction<Lanes<float>> traction{};
  FrameLoad<Lanes<float>> frame{};
  bool framed = false;

  FarFaceDrive of(FarEnd end) const {
    if (end == FarEnd::free) return traction;
    return {end, end == FarEnd::held ? displacement : force};
  }
  /// Returns one lane's load at a fraction of the tick.
  ReferenceLoad load(FarEnd end, std::size_t l, double part) const {
    const auto mix = [&](const Lanes<float>& from, const Lanes<float>& to) {
      return static_cast<double>(from[l]) + part * (static_cast<double>(to[l]) - static_cast<double>(from[l]));
    };
    const auto vector = [&](const Vec3<Lanes<float>>& a, const Vec3<Lanes<float>>& b) {
      return Vec3<double>{mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z)};
    };
    ReferenceLoad at;
    if (end == FarEnd::held) at.end.z = mix(displacement.from, displacement.to);
    if (end == FarEnd::sliding) at.end.z = mix(force.from, force.to);
    if (end == FarEnd::free) at.end = vector(traction.from_n, traction.to_n);
    if (!framed) return at;
    at.constant = vector(frame.constant_from, frame.constant_to);
    const auto &g = frame.gradient_from, &h = frame.gradient_to;
    at.gradient = {vector(g.x, h.x), vector(g.y, h.y), vector(g.z, h.z)};
    return at;
  }
};

/// Returns a smooth drive that starts from rest and differs in every lane.
inline EndPull drive_at(double t, double size, bool framed) {
  EndPull drive;
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

  /// Bellies of all sizes within the given fractions of the solver's ratio and of its S·l.
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
  void tick(const EndPull& drive, std::uint32_t substeps, float length_s = tick_s) {
    const BellyBlock block{
        muscle, scale, u.data()->lane, v.data()->lane, report, stiffness, drive.framed ? &drive.frame : nullptr};
    const FarFaceDrive end = drive.of(muscle.options.far_end);
    if (solver.method == Method::explicit_central) return deform_explicit(block, end, substeps, length_s);
    deform_implicit(block, solver, end, substeps, length_s, scratch.data()->lane);
  }
  Vector lane(const std::vector<Lanes<float>>& column, std::size_t l) const {
    Vector x(static_cast<Eigen::Index>(column.size()));
    for (std::size_t i = 0; i < column.size(); ++i) x(static_cast<Eigen::Index>(i)) = static_cast<double>(column[i][l]);
    return x;
  }
};

struct Distance {
  double displacement = 0, report = 0;  // worst lane's, relative to the norm of the history
};

/// Returns the distance from the same bellies in double precision, which reference_test compares with dense matrices.
inline Distance distance_from_reference(Block& block, bool framed, int ticks, std::uint32_t substeps) {
  const MuscleTemplate& muscle = block.muscle;
  const MuscleOptions& options = muscle.options;
  const Method method = block.solver.method;
  const std::uint32_t steps = method == Method::statics ? 1 : substeps;
  std::vector<ReferenceBelly> model;
  std::vector<Matrix> elastic;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const auto across = static_cast<double>(block.scale.across[l]), along = static_cast<double>(block.scale.along[l]);
    ReferenceOptions o{method, block.solver.mass, options.far_end, static_cast<double>(tick_s) / steps};
    o.damping_per_s = options.damping_per_s;
    o.stiffness_damping_s = options.stiffness_damping_s;
    o.foundation_1_s = 2 * std::numbers::pi * options.foundation_hz;
    o.across = across;
    o.along = along;
    model.push_back(ReferenceBelly::make(muscle.mesh, muscle.terms, o).value());
    if (options.foundation_hz > 0)
      elastic.push_back(oracle::assemble(scaled(muscle.mesh, across, along), muscle.material).stiffness);
  }
  std::vector<std::array<double, 5>> error(lane_count), norm(lane_count);
  for (int tick = 0; tick < ticks; ++tick) {
    const EndPull drive = drive_at(tick * static_cast<double>(tick_s), 1, framed);
    block.tick(drive, substeps);
    for (std::size_t l = 0; l < lane_count; ++l) {
      ReferenceBelly& belly = model[l];
      const Eigen::Map<const Vector> u(belly.displacement().data(), static_cast<Eigen::Index>(block.u.size()));
      Vector before = u;
      for (std::uint32_t s = 0; s < steps; ++s) {
        before = u;
        belly.step(drive.load(options.far_end, l, static_cast<double>(s) / steps),
                   drive.load(options.far_end, l, (s + 1.0) / steps));
      }
      error[l][0] += (block.lane(block.u, l) - u).squaredNorm();
      norm[l][0] += u.squaredNorm();
      ReferenceReport is = belly.report();
      const bool across_a_step = method == Method::explicit_central || method == Method::implicit_central;
      if (!elastic.empty()) is.strain_energy_j = 0.5 * (across_a_step ? before : u).dot(elastic[l] * u);
      const std::array expected = {is.reaction_n, is.elongation_m, is.kinetic_energy_j, is.strain_energy_j};
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

/// Displaces all moving components randomly.
inline void shake(Block& block, float size) {
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

inline double energy(const Block& block, std::size_t l) {
  return static_cast<double>(block.report.kinetic_energy_j[l]) + static_cast<double>(block.report.strain_energy_j[l]);
}

/// Returns the largest displacement, m; infinite if any is not finite.
inline double largest(const Block& block) {
  double most = 0;
  for (const auto& lanes : block.u) {
    for (const float x : lanes.lane) most = std::isfinite(x) ? std::max(most, std::abs(double{x})) : INFINITY;
  }
  return most;
}

}  // namespace mobil::oracle
