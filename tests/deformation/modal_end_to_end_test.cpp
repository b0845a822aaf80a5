// Modal bellies, from a mesh to control points and reports, compared with the full mesh in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "assets/reduction/modal_basis.h"
#include "demo/lab/reference/reference.h"
#include "systems/deformation/modal.h"
#include "tests/fem/spindle.h"
#include "tests/labels.h"

namespace mobil::modal_end_to_end_test {
constexpr double tick_s = 1.0 / 60, damping = 8, foundation_hz = 7;
constexpr Cells fine_cells = {4, 4, 16}, control_cells = {2, 2, 8};
constexpr std::array<double, 2> across = {0.9, 1.08}, along = {0.85, 1.1};

struct Case {
  FarEnd end;
  bool frame;
};

/// Returns the load at the end of tick `n`: an elongation of some millimetres (a pull of some tenths of a newton) that
/// starts suddenly, a swinging frame, and heel strikes.
ReferenceLoad load_at(const Case& what, int n) {
  const double t = n * tick_s, start = std::min(1.0, 8 * t);
  const double swing = start * (std::sin(7 * t) + 0.3 * std::sin(29 * t));
  ReferenceLoad load;
  if (what.end == FarEnd::held) load.end.z = 0.008 * swing;
  if (what.end == FarEnd::sliding) load.end.z = 0.3 * swing;
  if (what.end == FarEnd::free) load.end = {0.006 * swing, -0.004 * swing, 0.3 * swing};
  if (what.frame) {
    const double strike = n % 50 == 20 ? 12 : 0;
    load.constant = {start * 3 * std::sin(6 * t), start * 2 * std::cos(9 * t), -start * 9.8 + strike};
    load.gradient.x = {-2, 20 * std::sin(5 * t) * start, 15 * start};
    load.gradient.y = {20 * std::sin(3 * t) * start, -4 * start, 40 * std::sin(6 * t) * start};
    load.gradient.z = {0, 30 * start * std::cos(8 * t), 25 * start * std::sin(4 * t)};
  }
  return load;
}

ReferenceLoad between(const ReferenceLoad& a, const ReferenceLoad& b, double part) {
  const auto mix = [part](const Vec3<double>& p, const Vec3<double>& q) {
    return Vec3<double>{p.x + part * (q.x - p.x), p.y + part * (q.y - p.y), p.z + part * (q.z - p.z)};
  };
  return {mix(a.end, b.end),
          mix(a.constant, b.constant),
          {mix(a.gradient.x, b.gradient.x), mix(a.gradient.y, b.gradient.y), mix(a.gradient.z, b.gradient.z)}};
}

struct History {
  std::vector<std::vector<double>> displacement;  // of the control points, one a tick
  std::vector<std::array<double, 4>> report;      // elongation, reaction, kinetic and strain energy
};

constexpr int ticks = 60;

/// Returns the mean of the histories with lumped and with consistent mass, because a basis uses the mean of both.
History reference(const Case& what, std::size_t lane) {
  History mean;
  mean.displacement.resize(ticks);
  mean.report.resize(ticks);
  const HexahedralMesh mesh = spindle(fine_cells);
  const StiffnessTerms terms = *assemble(mesh, Material{});
  constexpr int parts = 8;
  for (const Mass mass : {Mass::lumped, Mass::consistent}) {
    ReferenceOptions options;
    options.method = Method::newmark;
    options.mass = mass;
    options.end = what.end;
    options.dt_s = tick_s / parts;
    options.damping_per_s = damping;
    options.foundation_1_s = 2 * std::numbers::pi * foundation_hz;
    options.across = across[lane];
    options.along = along[lane];
    ReferenceBelly belly = *ReferenceBelly::make(mesh, terms, options);
    for (int n = 0; n < ticks; ++n) {
      const ReferenceLoad from = load_at(what, n), to = load_at(what, n + 1);
      for (int part = 0; part < parts; ++part) {
        belly.step(between(from, to, static_cast<double>(part) / parts),
                   between(from, to, static_cast<double>(part + 1) / parts));
      }
      auto& u = mean.displacement[static_cast<std::size_t>(n)];
      u.resize(nodal_width(control_cells));
      std::size_t at = 0;
      for_each_node(control_cells, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        const std::size_t node = node_index(fine_cells, 2 * i, 2 * j, 2 * k);
        for (std::size_t c = 0; c < 3; ++c) u[at++] += belly.displacement()[3 * node + c] / 2;
      });
      const ReferenceReport report = belly.report();
      const std::array figures = {report.elongation_m, report.reaction_n, report.kinetic_energy_j,
                                  report.strain_energy_j};
      for (std::size_t i = 0; i < 4; ++i) mean.report[static_cast<std::size_t>(n)][i] += figures[i] / 2;
    }
  }
  return mean;
}

/// Returns the histories of both bodies, in the first lanes of a block.
std::array<History, 2> modal(const Case& what) {
  std::array<History, 2> histories;
  ModalBasisOptions options;
  options.modes = max_modes;
  options.far_end = what.end;
  options.frame_loads = what.frame;
  options.corrected = false;
  options.foundation_hz = foundation_hz;
  options.damping_per_s = damping;
  options.middle_ratio = 1.02;
  options.ratio_width = 1.05;
  options.control_cells = control_cells;
  const auto made = make_modal_basis(spindle(fine_cells), Material{}, Element::full, options);
  if (!made) {
    ADD_FAILURE() << made.error().message;
    return histories;
  }
  const ModalBasis& basis = *made;
  const auto control = make_muscle_template(spindle(control_cells), Material{}, {.far_end = what.end});
  std::vector<Lanes<float>> state(modal_state_width(basis.modes));
  std::vector<Lanes<float>> motion(modal_motion_width(basis.modes, basis.inputs));
  std::vector<Lanes<float>> shape(modal_shape_width(basis.modes, basis.inputs));
  std::vector<Lanes<float>> displacement(nodal_width(control_cells));
  BellyScale<Lanes<float>> scale{};
  for (std::size_t l = 0; l < lane_count; ++l) {
    const double s = across[l % 2], length = along[l % 2];
    scale.across[l] = static_cast<float>(s);
    scale.along[l] = static_cast<float>(length);
    const auto belly = make_modal_belly(basis, s, length);
    if (!belly) {
      ADD_FAILURE() << belly.error().message;
      return histories;
    }
    std::vector<float> row(motion.size());
    write_motion(*belly, damping, tick_s, row);
    for (std::size_t i = 0; i < row.size(); ++i) motion[i][l] = row[i];
    row.resize(shape.size());
    write_shape(*belly, damping, row);
    for (std::size_t i = 0; i < row.size(); ++i) shape[i][l] = row[i];
  }
  BellyReport<Lanes<float>> report{};
  const ControlPoints points{shape.data()->lane, displacement.data()->lane};
  const auto fill = [](Vec3<Lanes<float>>& to, const Vec3<double>& from) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      to.x[l] = static_cast<float>(from.x);
      to.y[l] = static_cast<float>(from.y);
      to.z[l] = static_cast<float>(from.z);
    }
  };
  for (int n = 0; n < ticks; ++n) {
    EndTraction<Lanes<float>> end{};
    FrameLoad<Lanes<float>> frame{};
    const ReferenceLoad from = load_at(what, n), to = load_at(what, n + 1);
    fill(end.from_n, from.end);
    fill(end.to_n, to.end);
    fill(frame.constant_from, from.constant);
    fill(frame.constant_to, to.constant);
    fill(frame.gradient_from.x, from.gradient.x);
    fill(frame.gradient_from.y, from.gradient.y);
    fill(frame.gradient_from.z, from.gradient.z);
    fill(frame.gradient_to.x, to.gradient.x);
    fill(frame.gradient_to.y, to.gradient.y);
    fill(frame.gradient_to.z, to.gradient.z);
    FarFaceDrive drive(end);
    drive.way = what.end;
    const ModalBlock block{basis, scale, state.data()->lane, motion.data()->lane, what.frame ? &frame : nullptr};
    deform_modal(block, drive, static_cast<float>(tick_s));
    place_control_points(block, points, drive);
    report_modal(block, *control, points, drive, static_cast<float>(tick_s), report);
    for (std::size_t l = 0; l < 2; ++l) {
      auto& u = histories[l].displacement.emplace_back();
      for (const auto& lanes : displacement) u.push_back(static_cast<double>(lanes[l]));
      histories[l].report.push_back(
          {static_cast<double>(report.elongation_m[l]), static_cast<double>(report.reaction_n[l]),
           static_cast<double>(report.kinetic_energy_j[l]), static_cast<double>(report.strain_energy_j[l])});
    }
  }
  return histories;
}

/// Returns the root mean square of the difference, divided by that of the full mesh's history.
template <class Pick>
double distance(const History& fast, const History& whole, Pick&& pick) {
  double error = 0, size = 0;
  for (std::size_t n = 0; n < ticks; ++n) {
    const auto a = pick(fast, n), b = pick(whole, n);
    for (std::size_t i = 0; i < b.size(); ++i) {
      error += (a[i] - b[i]) * (a[i] - b[i]);
      size += b[i] * b[i];
    }
  }
  return std::sqrt(error / size);
}

TEST(ModalEndToEnd, BelliesMoveAndReportAsTheFullMesh) {
  MOBIL_SLOW();
  for (const Case& what :
       {Case{FarEnd::held, false}, Case{FarEnd::held, true}, Case{FarEnd::sliding, false}, Case{FarEnd::free, true}}) {
    const auto fast = modal(what);
    for (std::size_t lane = 0; lane < across.size(); ++lane) {
      SCOPED_TRACE(::testing::Message() << "far end " << static_cast<int>(what.end) << " lane " << lane);
      ASSERT_FALSE(fast[lane].report.empty());
      const History whole = reference(what, lane);
      EXPECT_LT(distance(fast[lane], whole, [](const History& h, std::size_t n) { return h.displacement[n]; }), 0.01);
      const auto figure = [&](std::size_t i) {
        return distance(fast[lane], whole, [i](const History& h, std::size_t n) { return std::array{h.report[n][i]}; });
      };
      EXPECT_LT(figure(0), 0.015);  // the far face's mean is over nine nodes instead of twenty-five
      // The full mesh's far nodes use part of the force for their own mass.
      EXPECT_LT(figure(1), what.end == FarEnd::held ? 0.04 : 0.1);
      EXPECT_LT(figure(2), 0.03);
      EXPECT_LT(figure(3), 0.01);
    }
  }
}

}  // namespace mobil::modal_end_to_end_test
