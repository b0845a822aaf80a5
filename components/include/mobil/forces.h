#pragma once
// The forces of a walk (paper, section 4.3): an effect; who lacks these components pays nothing.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include <mobil/components/pose.h>

namespace mobil::inline v0_3 {

/// What the ground does to each foot, world frame: force (N) and the centre of pressure it acts at (m, on the ground);
/// zero force where the foot is in the air. Of people whose host animates them: one tick ago. Index 0 right, 1 left.
template <class F>
struct GroundReaction {
  Vec3<F> force_n[2];
  Vec3<F> centre_m[2];
};

/// Internal sagittal moments, N m, at the instant of the ground reaction: hip and knee extensor positive, ankle
/// plantarflexor positive. Index 0 right, 1 left.
template <class F>
struct JointMoments {
  F hip_nm[2], knee_nm[2], ankle_nm[2];
};

/// The points of the legs that moments are taken of: of each leg, right before left, five.
inline constexpr std::size_t leg_points = 5;
enum LegPoint : std::size_t { hip_point, knee_point, ankle_point, ball_point, foot_centre_point };
constexpr std::size_t leg_point(std::size_t side, LegPoint p) {
  return side * leg_points + p;
}

/// Between the poses that a walker's motion is taken from, s: longer blurs, shorter shows single precision.
inline constexpr float motion_difference_s = 0.006F;

/// Of a person whose host animates the skeleton, what its motion is taken from: the poses of the last two ticks, the
/// newer one first; how high its lowest sole was, m; and how many of the poses are known.
template <class F>
struct PoseHistory {
  static constexpr std::uint64_t stable_id = 0xf987aad48bfed529;
  Pose<F> pose[2];
  F floor_m;
  UInt32<F> known;
};

/// How a walker moves now, in the frame of the stance foothold: x to the left, y up, z the way the walking line heads
/// there. What accelerates the body against gravity, Σ m (a + g), and the moment of that with its turning about the
/// foothold, Σ r × m (a + g) + dL/dt, over all 48 segments; per kg of the body's mass. Places (m) and accelerations
/// (m/s²) of the legs' points. The way the thighs face and each foot points (unit, on the ground), and the foot's pitch
/// (rad, toes up).
template <class F>
struct BodyMotion {
  Vec3<F> force_per_kg, moment_per_kg;
  F centre_height_m;
  Vec3<F> place_m[2 * leg_points], acceleration[2 * leg_points];
  F facing_x, facing_z;
  F foot_x[2], foot_z[2], foot_pitch[2];
};

}  // namespace mobil::inline v0_3
