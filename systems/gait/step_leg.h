#pragma once
// One leg of a steady walk in double precision, seen from its own heel strike at t = 0 to the next one two steps
// later: where its hip is, how its foot rolls over heel and ball while it stands, and the angles of thigh and shank.
// Places relative to the foothold (the ground under the ankle of the flat foot): z forward, y up, out to the side.

#include <array>
#include <vector>

#include "components/body.h"
#include "components/gait.h"
#include "systems/gait/step_support.h"

namespace mobil::step {

struct Point {
  double out, up, forward;
};

struct Foot {
  double pitch;  // toes up positive
  Point ankle;
};

/// Sagittal angles in the leg's plane from the downward vertical, forward positive, and the distance and the
/// direction from hip to ankle.
struct LegAngles {
  double thigh, shank, reach, direction;
};

/// Lengths, timing and amplitudes of one individual's step, in m, s, rad.
struct Leg {
  double thigh, shank, heel_back, ball_forward, ankle_height, toe_joint_height, toes_length, hip_half_spacing;
  double duration, double_support, flat, toe_off, step_length, half_width, pivot_forward;
  double toe_out, strike_pitch, strike_knee, stance_knee, toe_off_knee, release;
  double rotation, list, shift;
  std::vector<HipSample> hip_path;  // relative to the support pivot, as solve_support gives it

  /// Distance between hip and ankle at a knee flexion, and the reverse.
  double reach(double knee) const;
  double knee(double reach_m) const;
  /// The middle of the hips at time t after this leg's heel strike, then this leg's own hip; any t, also negative.
  HipSample middle(double t) const;
  Point hip(double t) const;
  /// Acceleration of this leg's hip: forward, up.
  std::array<double, 2> hip_acceleration(double t) const;
  /// The foot turned by `pitch` about heel (toes up) or ball (heel up) at its foothold.
  Foot planted(double pitch) const;
  /// The standing foot at time t, from heel strike to toe-off (and smoothly a little beyond either).
  Foot stance(double t) const;
  LegAngles angles(const Point& hip_at, const Point& ankle) const;
  /// Pelvis contributions of this leg's hip relative to the middle: forward, up, out.
  Point hip_offset(double t) const;
};

/// Geometry and timing of a body's leg at a gait, before the support step is known (hip_path empty).
Leg make_leg(const Body& body, const Gait& gait);

/// The support step that goes with it: masses, leg spring, and the heights between which the hip moves.
SupportRequest support_request(const Body& body, const Gait& gait, const Leg& leg);

}  // namespace mobil::step
