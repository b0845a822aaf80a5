#pragma once
// Path lengths of the published models of tests/lines/opensim_strands.h, in double precision. Independent of the
// library: paths wrap around the models' cylinders.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/lines/opensim_strands.h"
#include "tests/lines/turned_leg.h"

namespace mobil::test::opensim {

/// Axis of the joint below the ankle in gait2392.
inline const Eigen::Vector3d inversion_axis(subtalar_axis.z, subtalar_axis.y, -subtalar_axis.x);

using Frame = Eigen::Isometry3d;

inline Eigen::AngleAxisd about(const Eigen::Vector3d& axis, double rad) {
  return {rad, axis.normalized()};
}

inline Frame frame(const Eigen::Vector3d& at, const Eigen::Matrix3d& turn) {
  Frame made = Frame::Identity();
  made.linear() = turn;
  made.translation() = at;
  return made;
}

/// Returns the natural cubic spline through values at 0, 1, 2, … at `u`. Beyond the ends the last piece continues.
template <std::size_t count>
double natural_spline(const std::array<double, count>& value, double u) {
  static const Eigen::MatrixXd to_curvature = [] {  // second derivatives at the knots from the values
    Eigen::MatrixXd left = Eigen::MatrixXd::Identity(count, count), right = Eigen::MatrixXd::Zero(count, count);
    for (Eigen::Index i = 1; i + 1 < Eigen::Index{count}; ++i) {
      left.block(i, i - 1, 1, 3) << 1, 4, 1;
      right.block(i, i - 1, 1, 3) << 6, -12, 6;
    }
    return Eigen::MatrixXd(left.partialPivLu().solve(right));
  }();
  const Eigen::Map<const Eigen::VectorXd> y(value.data(), count);
  const Eigen::VectorXd m = to_curvature * y;
  const auto i = static_cast<Eigen::Index>(std::clamp(std::floor(u), 0.0, static_cast<double>(count - 2)));
  const double b = u - static_cast<double>(i), a = 1 - b;
  return a * y[i] + b * y[i + 1] + ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]) / 6;
}

inline Frame rajagopal_tibia(double knee_rad) {
  std::array<double, 6> at{};
  for (std::size_t k = 0; k < 6; ++k) {
    std::array<double, knee_rows> column{};
    for (std::size_t row = 0; row < knee_rows; ++row) column[row] = knee_motion[row][k];
    at[k] = natural_spline(column, knee_rad * 18 / std::numbers::pi);
  }
  const double degree = std::numbers::pi / 180;
  const Eigen::Matrix3d turn =
      (about(Eigen::Vector3d::UnitZ(), -at[3] * degree) * about(Eigen::Vector3d::UnitX(), at[4] * degree) *
       about(Eigen::Vector3d::UnitY(), at[5] * degree))
          .toRotationMatrix();
  return frame({at[0], at[1], at[2]}, turn);
}

/// Bones of a model at these angles, in the pelvis' frame. gait2392's muscles here cross either the hip or the ankle,
/// so that its knee is left straight. Rajagopal's end at the tibia.
struct Leg {
  std::array<Frame, 5> bone;
  Leg(Model model, const Angles& q) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
    const bool rajagopal = model == Model::rajagopal2016;
    const Eigen::Vector3d hip =
        rajagopal ? Eigen::Vector3d(-0.05628, -0.07849, 0.07726) : Eigen::Vector3d(-0.0707, -0.0661, 0.0835);
    bone[pelvis] = Frame::Identity();
    bone[femur] = frame(
        hip, (about(z, q[hip_flexion]) * about(x, q[hip_adduction]) * about(y, q[hip_rotation])).toRotationMatrix());
    bone[tibia] = bone[femur] * (rajagopal ? rajagopal_tibia(q[knee]) : Frame::Identity());
    const Frame talus =
        frame({0, -0.43, 0}, about({-0.10501355, -0.17402245, 0.97912632}, q[ankle]).toRotationMatrix());
    const Frame heel = frame({-0.04877, -0.04195, 0.00792}, about(inversion_axis, q[subtalar]).toRotationMatrix());
    const Frame tip = frame({0.1788, -0.002, 0.00108}, about({-0.58095468, 0, 0.81393611}, q[toe]).toRotationMatrix());
    bone[calcaneus] = bone[tibia] * talus * heel;
    bone[toes] = bone[calcaneus] * tip;
  }
};

/// Returns by how much the shortest way from a to b around the cylinder is longer than the straight line; 0 if that is
/// free.
inline double detour(const Leg& leg, const Cylinder& around, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d turn = around.turn_deg * std::numbers::pi / 180;
  const Frame own = leg.bone[around.bone] * frame(around.at, (about(Eigen::Vector3d::UnitX(), turn.x()) *
                                                              about(Eigen::Vector3d::UnitY(), turn.y()) *
                                                              about(Eigen::Vector3d::UnitZ(), turn.z()))
                                                                 .toRotationMatrix());
  const Eigen::Vector3d from = own.inverse() * a, to = own.inverse() * b;
  const Eigen::Vector2d u = from.head<2>(), v = to.head<2>(), d = v - u;
  const double r = around.radius, near_at = std::clamp(-u.dot(d) / d.squaredNorm(), 0.0, 1.0);
  const Eigen::Vector2d nearest = u + near_at * d;
  if (u.norm() <= r || v.norm() <= r) return 0;
  struct Way {
    double flat, arc, toward;  // length across the axis, angle on the cylinder, middle of the arc along `side`
  };
  const double first = std::sqrt(u.squaredNorm() - r * r), last = std::sqrt(v.squaredNorm() - r * r);
  const auto way = [&](double sense) {
    const double leaves = std::atan2(u.y(), u.x()) + sense * std::acos(r / u.norm());
    const double arrives = std::atan2(v.y(), v.x()) - sense * std::acos(r / v.norm());
    const double turns = sense * (arrives - leaves) / (2 * std::numbers::pi);
    const double arc = 2 * std::numbers::pi * (turns - std::floor(turns)), middle = leaves + sense * arc / 2;
    return Way{first + r * arc + last, arc, around.side.dot(Eigen::Vector2d(std::cos(middle), std::sin(middle)))};
  };
  const Way one = way(1), other = way(-1);
  const bool sided = !around.side.isZero();
  const Way& taken = (sided ? one.toward > other.toward : one.flat < other.flat) ? one : other;
  const bool on_wrong_side = sided && around.side.dot(nearest) < 0;
  if (nearest.norm() >= r && !on_wrong_side) return 0;
  if (sided && taken.arc >= std::numbers::pi) return 0;
  const double z = to.z() - from.z(), enters = from.z() + z * first / taken.flat,
               exits = from.z() + z * (taken.flat - last) / taken.flat;
  if (std::min(std::abs(enters), std::abs(exits)) >= around.length / 2) return 0;
  return std::hypot(taken.flat, z) - std::hypot(d.norm(), z);
}

/// Returns a strand's path length, m. The cylinder bends the first segment that meets it.
inline double path_length(const Strand& strand, const Leg& leg) {
  double sum = 0;
  bool bent = false;
  for (std::size_t i = 1; i < strand.path.size(); ++i) {
    const Eigen::Vector3d a = leg.bone[strand.path[i - 1].bone] * strand.path[i - 1].at,
                          b = leg.bone[strand.path[i].bone] * strand.path[i].at;
    sum += (b - a).norm();
    if (!strand.cylinder || bent || (strand.cylinder->only_second_segment && i != 2)) continue;
    const double longer = detour(leg, *strand.cylinder, a, b);
    bent = longer != 0;
    sum += longer;
  }
  return sum;
}

}  // namespace mobil::test::opensim
