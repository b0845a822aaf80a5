#pragma once
// Forces of a walk (section 4.3 of the paper): an optional effect without cost for rows that lack the components.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// Ground reaction of each foot, world frame: force (N), its centre of pressure (m, on the ground), and the free moment
/// there, about the vertical (N m, positive to the left). All are zero for a foot in the air. For people whose host
/// animates them they are one tick old. Index 0 right, 1 left.
template <class F>
struct GroundReaction {
  Vec3<F> force_n[2];
  Vec3<F> centre_m[2];
  F free_moment_nm[2];
};

/// Internal moments, N m, at the instant of the ground reaction. Sagittal ones: hip and knee extensor positive, ankle
/// plantarflexor positive. At the hip also the frontal one, abductor positive, and the transverse one, inward rotator
/// positive. Index 0 right, 1 left.
template <class F>
struct JointMoments {
  F hip_nm[2], knee_nm[2], ankle_nm[2];
  F hip_abduction_nm[2], hip_rotation_nm[2];
};

/// Points of the legs about which moments are taken: five a leg, right before left.
inline constexpr std::size_t leg_points = 5;
enum LegPoint : std::size_t { hip_point, knee_point, ankle_point, ball_point, foot_centre_point };
constexpr std::size_t leg_point(std::size_t side, LegPoint p) {
  return side * leg_points + p;
}

/// Time between the poses from which a walker's motion is computed, s. Longer blurs, shorter amplifies rounding.
inline constexpr float motion_difference_s = 0.006F;

/// Recent poses of a person whose host animates the skeleton: those of the last two ticks, the newer one first; height
/// of the lowest sole in the last tick, m; number of known poses. The person's motion is computed from them.
template <class F>
struct PoseHistory {
  static constexpr std::uint64_t stable_id = 0xf987aad48bfed529;
  Pose<F> pose[2];
  F floor_m;
  UInt32<F> known;
};

/// Motion of a walker, in the frame of the stance foothold: x to the left, y up, z along the walking line there. Force
/// Σ m (a + g), and its moment with the change of angular momentum about the foothold, Σ r × m (a + g) + dL/dt. Both
/// are sums over all 48 segments, per kg of body mass. Positions (m) and accelerations (m/s²) of the legs' points.
/// Directions of the thighs and of each foot (unit, on the ground), and the foot's pitch (rad, toes up).
template <class F>
struct BodyMotion {
  Vec3<F> force_per_kg, moment_per_kg;
  F centre_height_m;
  Vec3<F> place_m[2 * leg_points], acceleration[2 * leg_points];
  F facing_x, facing_z;
  F foot_x[2], foot_z[2], foot_pitch[2];
};

}  // namespace mobil::inline v0_3
