#pragma once
// The forces of a walk (paper, section 4.3): an effect; who lacks these components pays nothing.

#include <cstddef>

#include "components/lanes.h"

namespace mobil {

/// What the ground does to each foot, world frame: force (N) and the centre of pressure it acts at (m, on the ground);
/// zero force where the foot is in the air. Index 0 right, 1 left.
template <class F>
struct GroundReaction {
  Vec3<F> force_n[2];
  Vec3<F> centre_m[2];
};

/// Internal sagittal moments, N m: hip and knee extensor positive, ankle plantarflexor positive. Index 0 right, 1 left.
template <class F>
struct JointMoments {
  F hip_nm[2], knee_nm[2], ankle_nm[2];
};

/// Where a foot would press the ground with the body rolling over it, on the ground of the world: the point (m), the
/// direction from heel to toe (unit), and how far along it the sole in contact reaches behind and ahead of the point
/// (m).
template <class F>
struct FootContact {
  F x_m, z_m;
  F along_x, along_z;
  F back_m, ahead_m;
};

/// The points that accelerations are taken of: the body's centre of mass, then of each leg, right before left, five.
inline constexpr std::size_t leg_points = 5;
enum LegPoint : std::size_t { hip_point, knee_point, ankle_point, ball_point, foot_centre_point };
constexpr std::size_t tracked_point(std::size_t side, LegPoint p) {
  return 1 + side * leg_points + p;
}
inline constexpr std::size_t tracked_points = 1 + 2 * leg_points;

/// What `joint_forces` keeps from one tick to the next: the last tick's places and contacts, and how far each point had
/// come in the tick before (m, world frame). 328 bytes a person. All zero: nothing is known yet; two ticks later it is.
template <class F>
struct MotionHistory {
  Vec3<F> place_m[tracked_points], step_m[tracked_points];
  FootContact<F> contact[2];
  F forward_x, forward_z;  // the way the thighs face, unit
  F load_right;            // planned share of the weight on the right foot
  F ticks_known;           // 0, 1, or 2 for two and more
};

}  // namespace mobil
