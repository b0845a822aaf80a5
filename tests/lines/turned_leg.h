#pragma once
// A right leg posed by all angles of a musculoskeletal model, in double precision, and moment arms about these.

#include <array>
#include <cstddef>

#include <mobil/engine/geometry.h>
#include "tests/lines/leg_pose.h"

namespace mobil::test {

/// Joint angles, rad: flexion, adduction and inward rotation of the hip, flexion of the knee, dorsiflexion, inversion
/// below the ankle, extension of the toes.
enum Freedom : std::size_t { hip_flexion, hip_adduction, hip_rotation, knee, ankle, subtalar, toe, freedoms };
using Angles = std::array<double, freedoms>;

/// Axis of the joint below the ankle in gait2392 (CC BY 3.0, Delp et al. 1990), in mobil's axes.
inline constexpr Vec3<double> subtalar_axis = {0.12094949, 0.60474746, 0.7871796};

/// Returns a leg at these angles, its hip at the origin of an upright pelvis. The toes are a part of the foot.
inline LegFrames<double> turned_leg(const Angles& q, double thigh_m, double shank_m) {
  using namespace geometry;
  const auto turned = [](const Quat<double>& from, const Vec& axis, double rad) {
    return product(from, about(axis, rad / degree));
  };
  LegFrames<double> leg{};
  leg.pelvis = {0, 0, 0, 1};
  leg.thigh = turned(turned(turned(leg.pelvis, {-1, 0, 0}, q[hip_flexion]), {0, 0, 1}, q[hip_adduction]), {0, 1, 0},
                     q[hip_rotation]);
  leg.shank = turned(leg.thigh, {1, 0, 0}, q[knee]);
  leg.foot = turned(turned(leg.shank, {-1, 0, 0}, q[ankle]), subtalar_axis, q[subtalar]);
  leg.knee_m = rotated(leg.thigh, {0, -thigh_m, 0});
  leg.ankle_m = leg.knee_m + rotated(leg.shank, {0, -shank_m, 0});
  return leg;
}

/// Returns the moment arm −dL/dq of a length that is a function of the angles.
template <class Length>
double arm(const Length& length, Angles q, std::size_t freedom) {
  constexpr double h = 1e-4;
  q[freedom] += h;
  const double more = length(q);
  q[freedom] -= 2 * h;
  return (length(q) - more) / (2 * h);
}

}  // namespace mobil::test
