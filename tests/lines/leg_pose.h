#pragma once
// A right leg posed by its joint angles, in double precision, for tests of paths and lines of action.

#include <cmath>
#include <numbers>

#include <mobil/assets/muscles/muscle_plan.h>
#include <mobil/components/body.h>
#include <mobil/engine/geometry.h>

namespace mobil::test {

inline constexpr double degree = std::numbers::pi / 180;

struct LegAngles {
  double hip_deg = 0, knee_deg = 0, ankle_deg = 0;  // flexion, flexion, dorsiflexion
};

inline Quat<double> product(const Quat<double>& b, const Quat<double>& a) {
  return {b.w * a.x + b.x * a.w + b.y * a.z - b.z * a.y, b.w * a.y - b.x * a.z + b.y * a.w + b.z * a.x,
          b.w * a.z + b.x * a.y - b.y * a.x + b.z * a.w, b.w * a.w - b.x * a.x - b.y * a.y - b.z * a.z};
}

inline Quat<double> about(const Vec3<double>& axis, double deg) {
  const geometry::Vec n = geometry::normalised(axis);
  const double s = std::sin(deg * degree / 2);
  return {s * n.x, s * n.y, s * n.z, std::cos(deg * degree / 2)};
}

/// Returns the leg of a body at those angles under a pelvis turned by `pelvis`, with its hip centre at `hip_m`:
///
///      y ^   hip o
///        |        `. thigh     hip_deg: flexion moves the knee forward (+z)
///        |     knee o
///        |        .' shank     knee_deg: flexion moves the ankle backward
///        | ankle o___ foot     ankle_deg: dorsiflexion lifts the toes
///        +------------------> z
inline LegFrames<double> posed(const Body& body, const LegAngles& angles, const Quat<double>& pelvis = {0, 0, 0, 1},
                               const Vec3<double>& hip_m = {0, 0, 0}) {
  using namespace geometry;
  LegFrames<double> leg{};
  leg.pelvis = pelvis;
  leg.thigh = product(pelvis, about({1, 0, 0}, -angles.hip_deg));
  leg.shank = product(leg.thigh, about({1, 0, 0}, angles.knee_deg));
  leg.foot = product(leg.shank, about({1, 0, 0}, -angles.ankle_deg));
  leg.hip_m = hip_m;
  leg.knee_m = hip_m + rotated(leg.thigh, {0, -static_cast<double>(body.thigh_length_m), 0});
  leg.ankle_m = leg.knee_m + rotated(leg.shank, {0, -static_cast<double>(body.shank_length_m), 0});
  return leg;
}

}  // namespace mobil::test
