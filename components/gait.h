#pragma once
// How someone walks: what is asked for, the solved step that follows from it, and where in that step a walker is.

#include <optional>

#include "components/curve.h"
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

/// A walk that was found consistent and within range, by `resolve_gait` (systems/gait/gait.h): what a walker is to do.
/// All zero but the style: to stand.
template <class F>
struct Gait {
  F speed_m_s, step_length_m, step_frequency_hz;  // the mean of right and left steps
  /// One double support as a fraction of the cycle of two steps.
  F double_support_cycle;
  F heading_rad;      // to turn to
  Whole<F> revision;  // tells one request from the next
  GaitStyleOf<F> style;
};

/// When in a step the pelvis turns, lists, tilts and shifts, φ the phase of the step from 0 at heel strike of the
/// stance leg to 1 at the next, from the first harmonics of Schwartz, Rozumalski & Trost 2008 (free speed). Seen from
/// the stance leg:
///   rotation (that side forward) = A cos π(φ − rotation)
///   list (that side up) = A (first cos π(φ − first phase) + third cos 3π(φ − third phase))
///   tilt (anterior) = mean + A cos 2π(φ − tilt)
///   shift (toward that side) = A sin π(φ − shift)
/// The odd harmonics change sign from one step to the next as the sides change, so all are smooth through heel strike.
namespace pelvis_phase {
inline constexpr float rotation = 0.16F;
inline constexpr float list_first = 0.70F, list_first_phase = 0.272F;
inline constexpr float list_third = 0.30F, list_third_phase = 0.314F;
inline constexpr float tilt = -0.166F;
inline constexpr float shift = 0.10F;
}  // namespace pelvis_phase

/// One double support in percent of the cycle: `at_rest` less `per_cadence` for each step a minute (at a height of 1.8
/// m) as Bruderlin & Calvert have it, through Schwartz (2008): 12, 10 and 8 % at slow, free and fast speed.
namespace double_support_law {
inline constexpr double at_rest = 23.6, per_cadence = 0.131, least = 6.0, most = 18.0;
}

/// After toe-off the toes, bent upward against the pitch of the foot, straighten between these parts of the swing.
namespace swing_toes {
inline constexpr float from = 0.25F, to = 0.85F;
}

/// The manner of a walk at a heel strike: amplitudes and postures that blend from one strike to the next. Angles rad.
template <class F>
struct Manner {
  F pelvis_rotation, pelvis_list, pelvis_shift_m, pelvis_tilt, pelvis_tilt_wave;
  F shoulder_rotation, leg_back, leg_forward;  // range of the hip-to-ankle line, which the opposite arm follows
  F arm_back, arm_forward, elbow_back, elbow_forward, arm_abduction, forearm_pronation, finger_flexion;
};

/// How a walker is at a heel strike, the instant at which two steps meet: all that both must agree on so that pose and
/// joint angles go on smoothly. A function of body and gait alone (systems/gait/strike-inl.h), so it is known before
/// either step is solved. Standing is a strike too, of length 0 and no speed. m, s, rad.
template <class F>
struct Strike {
  F speed_m_s;             // of the gait that it belongs to; 0: standing
  F length_m;              // from the trailing foothold to the leading one
  F behind_m;              // hips behind the leading foothold
  F forward_velocity;      // of the hips
  F up_mean_m, up_wave_m;  // height of the hips: mean and amplitude of its wave, one a step
  F pace_hz;               // steps a second
  F trunk_pitch;
  F foot_pitch, foot_pitch_rate;  // of the leading foot, toes up
  F knee, knee_rate;              // to which the trailing knee may stretch
  F stance_knee, toe_off_knee;
  F half_width_m, toe_out;          // of the leading foot
  F double_support, flat, release;  // parts of the step after it: on both feet; until foot flat; until the knee yields
  Manner<F> manner;
};

/// One solved step of one individual, from the heel strike of its stance foot to the other's. Places relative to the
/// stance foothold, the point of the ground under the ankle when the foot is flat; z forward, y up, "out" away from the
/// body's middle on the leg's own side. Angles rad, lengths m, times s from heel strike.
template <class F>
struct StepPlan {
  F duration_s, double_support_s, flat_s;  // step; its first part on both feet; heel strike to foot flat
  F load_from, load_to;  // share of the weight on the support foot at the start and at the end of double support
  F step_length_m, length_before_m;  // to the next foothold, from the one before
  F phase_rate_from, phase_rate_to;  // of the phase of the step over the time as a part of the step
  F trailing_half_width_m, trailing_toe_out;
  Whole<F> revision;  // of the gait that it was solved for
  Whole<F> settled;   // 1: the next step is this one mirrored, as long as the gait stays
  Whole<F> clamped;   // 1: no forces within bounds make this step; it is as near as they come
  Strike<F> from, to;
  Curve<F> hip_forward_m, hip_up_m, trunk_pitch;  // over the step: the middle of the hips, the trunk's lean
  Curve<F> support_pitch;                         // toe-up pitch of the stance foot from foot flat to the end
  Curve<F> trailing_pitch;                        // of the other foot in double support
  /// The other foot from toe-off to heel strike: its pitch and its ankle, relative to the stance foothold.
  Curve<F> swing_pitch, swing_forward_m, swing_up_m;
  F swing_out_m[2], swing_out_slope[2];  // at its start and its end: the ankle's place to the side, its change a swing
};

/// Where a walker is: time since heel strike of the stance foot (0 right, 1 left), steps taken, and the point of the
/// walking line beside the stance foothold with the line's heading there: about +Y, 0 toward +Z, positive to the left;
/// how much the line turns to the next foothold and how much it turned from the one before. All zero: right heel
/// strike at the origin, walking toward +Z.
template <class F>
struct GaitState {
  F time_s;
  Whole<F> stance_side, steps;
  F line_x_m, line_z_m, heading_rad;
  F turn_rad, turn_before_rad;
};

}  // namespace mobil
