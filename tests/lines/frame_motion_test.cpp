// Inertial loads of a muscle's moving frame, compared with exact formulas; and a belly in the frame, compared with a
// model in space that has no frame.
#include "systems/lines/frame_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <mobil/engine/geometry.h>
#include "assets/fem/belly_solver.h"
#include "assets/fem/muscle_template.h"
#include "systems/deformation/deformation.h"
#include "tests/fem/oracle.h"

namespace mobil::frame_motion_test {
using namespace geometry;

constexpr double g = static_cast<double>(gravity_m_s2);
constexpr Vec down{0, -g, 0};

/// Origin and rotation of a frame at a time.
struct Frame {
  Vec origin;
  Quat<double> rotation;
};
using Motion = std::function<Frame(double)>;

Quat<double> about(const Vec& unit_axis, double rad) {
  const double s = std::sin(rad / 2);
  return {s * unit_axis.x, s * unit_axis.y, s * unit_axis.z, std::cos(rad / 2)};
}

/// Returns one lane of a load's constant part, or of a row of its gradient.
Vec of(const Vec3<Lanes<float>>& v, std::size_t l) {
  return to_double(Vec3<float>{v.x[l], v.y[l], v.z[l]});
}
std::array<Vec, 3> of(const Mat3<Lanes<float>>& m, std::size_t l) {
  return {of(m.x, l), of(m.y, l), of(m.z, l)};
}

/// Sixteen frames, passed to the system tick by tick.
struct Frames {
  LineOfAction<Lanes<float>> line{};
  FrameHistory<Lanes<float>> history{};
  FrameLoad<Lanes<float>> load{};

  void put(const Frame& frame, std::size_t l) {
    const auto p = to_float(frame.origin);
    const auto q = to_float(frame.rotation);
    line.start_m.x[l] = p.x, line.start_m.y[l] = p.y, line.start_m.z[l] = p.z;
    line.rotation.x[l] = q.x, line.rotation.y[l] = q.y, line.rotation.z[l] = q.z, line.rotation.w[l] = q.w;
  }
  void tick(const Motion& motion, double t, double dt) {
    for (std::size_t l = 0; l < lane_count; ++l) put(motion(t), l);
    frame_motion(line, history, load, static_cast<float>(dt));
  }
};

/// Returns constant + gradient·x of a motion from differences of its exact formula, in the frame at that time.
Vec exact_load(const Motion& motion, double t, const Vec& x) {
  const double h = 1e-4;
  const auto place = [&](double at) {
    const Frame f = motion(at);
    return f.origin + rotated(f.rotation, x);
  };
  const Vec a = 1 / (h * h) * ((place(t + h) - place(t)) - (place(t) - place(t - h)));
  return rotated(conjugate(motion(t).rotation), down - a);
}

Vec felt(const Vec& constant, const std::array<Vec, 3>& rows, const Vec& x) {
  return constant + Vec{dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
}

/// Returns the largest difference (m/s²) between the load at points of a muscle and the exact one a tick before.
double worst_error(const Motion& motion, double dt) {
  Frames frames;
  double worst = 0;
  for (int k = 0; k * dt < 1.2; ++k) {
    frames.tick(motion, k * dt, dt);
    if (k < 3) continue;
    for (const Vec& x : {Vec{0, 0, 0}, Vec{0.05, -0.02, 0}, Vec{0, 0.03, 0.4}}) {
      const Vec to = felt(of(frames.load.constant_to, 0), of(frames.load.gradient_to, 0), x);
      const Vec from = felt(of(frames.load.constant_from, 0), of(frames.load.gradient_from, 0), x);
      worst = std::max(worst, length(to - exact_load(motion, (k - 1) * dt, x)));
      worst = std::max(worst, length(from - exact_load(motion, (k - 2) * dt, x)));
    }
  }
  return worst;
}

const Vec slanted = normalised(Vec{0.5, -0.3, 0.8});

/// Returns uniform rotation about an axis through a fixed point.
Motion turning(double rate) {
  return [rate](double t) {
    const Quat<double> q = product(about(slanted, rate * t), about({1, 0, 0}, 0.7));
    return Frame{Vec{0.3, 1, -0.2} + rotated(about(slanted, rate * t), {0.2, 0.1, -0.3}), q};
  };
}

/// Returns a swing about a wandering axis with forward motion, as of a shank.
Motion swinging() {
  return [](double t) {
    const Quat<double> q = product(about(slanted, 0.8 * std::sin(6 * t)), about({0, 1, 0}, 0.5 * std::cos(4 * t)));
    return Frame{{0.05 * std::sin(9 * t), 1 + 0.03 * std::cos(8 * t), 1.3 * t + 0.02 * std::sin(12 * t)}, q};
  };
}

TEST(FrameMotion, FreelyFallingFrameHasNoLoad) {
  const Motion falling = [](double t) { return Frame{{0.3 * t, 2 - g / 2 * t * t, 1.2 * t}, about(slanted, 0.4)}; };
  Frames frames;
  for (int k = 0; k < 40; ++k) {
    frames.tick(falling, k / 60.0, 1 / 60.0);
    if (k < 3) continue;
    EXPECT_LT(length(of(frames.load.constant_to, 7)), 5e-3) << k;
    for (const Vec& row : of(frames.load.gradient_to, 7)) EXPECT_LT(length(row), 1e-2) << k;
  }
}

TEST(FrameMotion, FrameAtRestHasOnlyGravityFromTheFirstTick) {
  const Quat<double> q = about(slanted, 2.1);
  const Vec gravity = rotated(conjugate(q), down);
  Frames frames;
  for (int k = 0; k < 5; ++k) {
    frames.tick([&](double) { return Frame{{3, 1, 40}, q}; }, 0, 1 / 60.0);
    for (const auto* constant : {&frames.load.constant_from, &frames.load.constant_to}) {
      EXPECT_LT(length(of(*constant, 3) - gravity), 1e-4) << k;
    }
  }
}

TEST(FrameMotion, WalkInProgressStartsWithoutAKick) {
  const Motion even = [](double t) { return Frame{{0, 1, 1.4 * t}, about(slanted, 0.4)}; };
  Frames frames;
  for (int k = 0; k < 5; ++k) {
    frames.tick(even, 0.3 + k / 60.0, 1 / 60.0);
    EXPECT_LT(length(of(frames.load.constant_to, 0) - rotated(conjugate(about(slanted, 0.4)), down)), 5e-3) << k;
  }
}

TEST(FrameMotion, UniformRotationGivesTheCentrifugalField) {
  Frames frames;
  const double rate = 5;
  const auto motion = turning(rate);
  for (int k = 0; k < 10; ++k) frames.tick(motion, k / 60.0, 1 / 60.0);
  const Vec w = rotated(conjugate(motion(8 / 60.0).rotation), rate * slanted);
  const auto rows = of(frames.load.gradient_to, 0);
  const double at[3] = {w.x, w.y, w.z};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double row[3] = {rows[i].x, rows[i].y, rows[i].z};
      EXPECT_NEAR(row[j], (i == j ? rate * rate : 0) - at[i] * at[j], 0.02) << i << j;
    }
  }
}

TEST(FrameMotion, IsOfSecondOrderInTheTick) {
  for (const auto& motion : {turning(5), swinging()}) {
    const double coarse = worst_error(motion, 1 / 25.0), fine = worst_error(motion, 1 / 50.0);
    EXPECT_GT(coarse, 0.01);
    EXPECT_LT(coarse, 2);
    EXPECT_GT(coarse / fine, 3.4);  // 4, except for rounding
    EXPECT_LT(coarse / fine, 4.6);
  }
}

TEST(FrameMotion, FarFromTheOriginRoundingStaysSmall) {
  const Motion even = [](double t) { return Frame{{100, 1, 100 + 1.4 * t}, about(slanted, 0.4)}; };
  Frames frames;
  for (int k = 0; k < 200; ++k) {
    frames.tick(even, k / 60.0, 1 / 60.0);
    EXPECT_LT(length(of(frames.load.constant_to, 0) - rotated(conjugate(about(slanted, 0.4)), down)), 0.1);
  }
}

TEST(FrameMotion, MirrorImageHasTheMirroredLoad) {
  const auto motion = swinging();
  const Motion image = [&](double t) { return Frame{mirrored(motion(t).origin), mirrored(motion(t).rotation)}; };
  Frames a, b;
  const Vec x{0.03, -0.05, 0.3};
  for (int k = 0; k < 30; ++k) {
    a.tick(motion, k / 60.0, 1 / 60.0);
    b.tick(image, k / 60.0, 1 / 60.0);
    const Vec one = felt(of(a.load.constant_to, 0), of(a.load.gradient_to, 0), x);
    const Vec other = felt(of(b.load.constant_to, 0), of(b.load.gradient_to, 0), mirrored(x));
    EXPECT_LT(length(mirrored(one) - other), 1e-3);
  }
}

// ------------------------------------------------------------------------------------------------- a belly in it

MuscleTemplate belly(double foundation_hz, double damping_per_s) {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.03F, 0.025F}, {0.5F, 0.006F, -0.004F, 0.04F, 0.035F}, {1, 0, 0, 0.02F, 0.02F}};
  MuscleOptions options;
  options.damping_per_s = damping_per_s;
  options.foundation_hz = foundation_hz;
  auto made = make_muscle_template(*bend_block({2, 2, 4}, stations, 0.25), Material{}, options);
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

struct Bellies {
  const MuscleTemplate& muscle;
  BellyScale<Lanes<float>> scale{};
  EndDrive<Lanes<float>> end{};
  std::vector<Lanes<float>> u, v;
  BellyReport<Lanes<float>> report{};

  explicit Bellies(const MuscleTemplate& m) : muscle(m), u(nodal_width(m.mesh.cells)), v(nodal_width(m.mesh.cells)) {
    std::fill_n(scale.across.lane, lane_count, 1.0F);
    std::fill_n(scale.along.lane, lane_count, 1.0F);
  }
  BellyBlock block(const FrameLoad<Lanes<float>>& load) {
    return {muscle, scale, u.data()->lane, v.data()->lane, report, Stiffness::individual, &load};
  }
};

TEST(FrameMotion, BellySagsFiveMillimetresUnderSidewaysGravity) {
  const auto muscle = belly(7, 8);
  const auto solver = make_belly_solver(muscle, Method::statics, Mass::lumped, 0);
  ASSERT_TRUE(solver) << solver.error().message;
  Frames frames;  // lies on its side: its y is the world's
  frames.tick([](double) { return Frame{{0, 1, 0}, {0, 0, 0, 1}}; }, 0, 1 / 60.0);
  Bellies bellies(muscle);
  std::vector<Lanes<float>> scratch(scratch_floats(muscle, Method::statics) / lane_count);
  for (int i = 0; i < 4; ++i) {
    deform_implicit(bellies.block(frames.load), *solver, {FarEnd::held, bellies.end}, 1, 1 / 60.0F,
                    scratch.data()->lane);
  }
  double lowest = 0;
  for (std::size_t n = 0; n < muscle.mesh.node.size(); ++n) {
    lowest = std::min(lowest, static_cast<double>(bellies.u[3 * n + 1][0]));
  }
  const double loose = g / std::pow(2 * std::numbers::pi * 7, 2);  // a free mass on the foundation: 5.07 mm
  EXPECT_LT(lowest, -0.7 * loose);
  EXPECT_GT(lowest, -1.05 * loose);
}

/// Nodes as points in space, connected by springs whose stiffness turns with the frame, under gravity, with both faces
/// carried along. The model has no inertial forces of the frame.
class InSpace {
 public:
  InSpace(const MuscleTemplate& muscle, const Motion& motion)
      : muscle_(muscle), motion_(motion), model_(oracle::assemble(muscle.mesh, muscle.material)) {
    for (const auto& p : muscle.mesh.node) {
      rest_.push_back(p);
      place_.push_back(at(0, p));
      speed_.push_back(1 / 2e-6 * (at(1e-6, p) - at(-1e-6, p)));
    }
  }

  void run(double from, double to, double dt) {
    const auto count = static_cast<int>(std::lround((to - from) / dt));
    for (int i = 0; i < count; ++i) step(from + i * dt, dt);
  }

  Vec displacement(double t, std::size_t n) const {
    const Frame f = motion_(t);
    return rotated(conjugate(f.rotation), place_[n] - f.origin) - rest_[n];
  }

 private:
  Vec at(double t, const Vec& x) const {
    const Frame f = motion_(t);
    return f.origin + rotated(f.rotation, x);
  }

  void step(double t, double dt) {
    const Cells& cells = muscle_.mesh.cells;
    const auto moving = oracle::free_components(cells, FarEnd::held);
    oracle::Vector u(static_cast<Eigen::Index>(3 * rest_.size()));
    for (std::size_t n = 0; n < rest_.size(); ++n) {
      const Vec d = displacement(t, n);
      u.segment<3>(static_cast<Eigen::Index>(3 * n)) << d.x, d.y, d.z;
    }
    const oracle::Vector force = model_.stiffness * u;
    const Quat<double> q = motion_(t).rotation;
    const double braced = std::pow(2 * std::numbers::pi * muscle_.options.foundation_hz, 2);
    for (std::size_t n = 0; n < rest_.size(); ++n) {
      const auto i = static_cast<Eigen::Index>(3 * n);
      if (n < plane_nodes(cells) || n >= first_insertion_node(cells)) {
        place_[n] = at(t + dt, rest_[n]);
        continue;
      }
      const double m = model_.lumped(i);
      const Vec pull{-force(i) / m - braced * u(i), -force(i + 1) / m - braced * u(i + 1), -force(i + 2) / m};
      const Vec carried = 1 / 2e-6 * (at(t + 1e-6, rest_[n]) - at(t - 1e-6, rest_[n]));
      const Vec drag = muscle_.options.damping_per_s * (speed_[n] - carried);
      speed_[n] = speed_[n] + dt * (down + rotated(q, pull) - drag);
      place_[n] = place_[n] + dt * speed_[n];
    }
  }

  const MuscleTemplate& muscle_;
  const Motion& motion_;
  oracle::Model model_;
  std::vector<Vec> rest_, place_, speed_;
};

/// Largest displacement (m) of a belly that is first at rest, then shaken and turned, and the kernel's largest error.
struct Outcome {
  double largest = 0, worst = 0;
};

Outcome shake(double metres, double radians) {
  const Motion motion = [=](double t) {
    if (t <= 0) return Frame{{0, 1, 0}, about(slanted, 0.3)};
    const double s = std::pow(std::sin(std::min(t, 0.25) * 2 * std::numbers::pi), 2);
    return Frame{{0.6 * metres * s * std::sin(20 * t), 1 + metres * s * std::sin(14 * t), 0.5 * metres * s},
                 about(slanted, 0.3 + radians * s * std::sin(12 * t))};
  };
  const auto muscle = belly(7, 8);
  const double tick = 1 / 240.0, start = -1.5;
  const std::uint32_t substeps = substeps_within(critical_step(muscle.critical_steps, 1, 1).value(), tick);
  Bellies bellies(muscle);
  Frames frames;
  InSpace space(muscle, motion);
  Outcome outcome;
  for (auto k = static_cast<int>(start / tick); k * tick < 0.8; ++k) {
    const double t = k * tick;  // the kernel is a tick late
    frames.tick(motion, t, tick);
    deform_explicit(bellies.block(frames.load), {FarEnd::held, bellies.end}, substeps, static_cast<float>(tick));
    space.run(t - 2 * tick, t - tick, tick / 20);
    if (t < 0) continue;  // until then both sag
    for (std::size_t n = 0; n < muscle.mesh.node.size(); ++n) {
      const Vec there = space.displacement(t - tick, n);
      const Vec here{bellies.u[3 * n][0], bellies.u[3 * n + 1][0], bellies.u[3 * n + 2][0]};
      outcome.largest = std::max(outcome.largest, length(there));
      outcome.worst = std::max(outcome.worst, length(there - here));
    }
  }
  return outcome;
}

TEST(FrameMotion, BellyInAMovingFrameMovesAsInSpace) {
  // Effects that a linear belly neglects stay small: loads at displaced positions, Coriolis forces.
  const Outcome shaken = shake(0.03, 0), turned = shake(0, 0.3);
  EXPECT_GT(shaken.largest, 0.01);
  EXPECT_LT(shaken.worst, 0.01 * shaken.largest);
  EXPECT_GT(turned.largest, 0.006);
  EXPECT_LT(turned.worst, 0.1 * turned.largest);
}

}  // namespace mobil::frame_motion_test
