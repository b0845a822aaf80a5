#pragma once
// How someone walks: what is asked for, the solved step that follows from it, and where in that step a walker is.

#include <cstddef>
#include <optional>

#include "components/gait_style.h"
#include "components/lanes.h"

namespace mobil {

/// What a caller asks of a walk. Speed (m/s), step length (m) and step frequency (steps/s): any two give the third;
/// one alone is completed by step length = 0.004 · steps per minute · height (Bruderlin & Calvert); none means 5 km/h;
/// three must agree within 1 %. A speed of 0 asks to stand.
struct GaitRequest {
  std::optional<float> speed_m_s{}, step_length_m{}, step_frequency_hz{};
  GaitStyle style{};
};

/// A walk that was found consistent and within range, by `resolve_gait` (systems/gait/gait.h).
struct Gait {
  float speed_m_s = 0, step_length_m = 0, step_frequency_hz = 0;
  /// One double support as a fraction of the cycle of two steps.
  float double_support_cycle = 0;
  GaitStyle style{};
};

/// When in a step the pelvis turns, lists, tilts and shifts: phases as fractions of the step from heel strike of the
/// stance leg, from the first harmonics of Schwartz, Rozumalski & Trost 2008 (free speed). Seen from the stance leg:
///   rotation (that side forward) = A cos π(t/T − rotation)
///   list (that side up) = A (first cos π(t/T − first phase) + third cos 3π(t/T − third phase))
///   tilt (anterior) = mean + A cos 2π(t/T − tilt)
///   shift (toward that side) = A sin π(t − D/2)/T, D the time of double support
/// The odd harmonics change sign from one step to the next as the sides change, so all are smooth through heel strike.
namespace pelvis_phase {
inline constexpr double rotation = 0.16;
inline constexpr double list_first = 0.70, list_first_phase = 0.272;
inline constexpr double list_third = 0.30, list_third_phase = 0.314;
inline constexpr double tilt = -0.166;
}  // namespace pelvis_phase

/// A smooth curve over a known time: cubic Hermite through equally spaced knots; slopes are per interval, not per
/// second.
inline constexpr std::size_t knot_count = 17;
template <class F>
struct Curve {
  F value[knot_count], slope[knot_count];
};

/// One solved step of one individual, re-used for every step of a steady walk, sides mirrored. Times from heel strike
/// of the stance leg; places relative to the stance foothold, the point of the ground under the ankle when the foot is
/// flat; z forward, y up, "out" away from the body's middle on the leg's own side. Angles rad, lengths m.
template <class F>
struct StepPlan {
  F duration_s, double_support_s, flat_s;  // step; its first part on both feet; heel strike to foot flat
  F load_from, load_to;  // share of the weight on the support foot at the start and at the end of double support
  F step_length_m, half_width_m;
  F toe_out_sin, toe_out_cos, strike_pitch;
  F swing_out_from_m, swing_out_to_m;  // the ankle's place to the side at toe-off and at heel strike
  F pelvis_rotation, pelvis_list, pelvis_shift_m, pelvis_tilt, pelvis_tilt_wave;
  F shoulder_rotation, leg_back, leg_forward;  // range of the hip-to-ankle line, which the opposite arm follows
  F arm_back, arm_forward, elbow_back, elbow_forward, arm_abduction, forearm_pronation, finger_flexion;
  Curve<F> hip_forward_m, hip_up_m, trunk_pitch;  // over the step: the middle of the hips, the trunk's lean
  /// Toe-up pitch of the foot: [0] from foot flat to toe-off, [1] from toe-off to heel strike.
  Curve<F> foot_pitch[2];
  Curve<F> swing_forward_m, swing_up_m;  // the ankle from toe-off to heel strike, relative to its last foothold
  Curve<F> swing_toes;                   // upward bend of the toes from toe-off to heel strike
};

/// Where a walker is: time since heel strike of the stance foot (0 right, 1 left), steps taken, and the point of the
/// walking line beside the stance foothold. Heading about +Y, 0 toward +Z, positive to the left. All zero: right heel
/// strike at the origin, walking toward +Z.
template <class F>
struct GaitState {
  F time_s;
  Whole<F> stance_side, steps;
  F line_x_m, line_z_m, heading_rad;
};

}  // namespace mobil
