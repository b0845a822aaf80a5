#pragma once
// How someone walks: what is asked for, the solved step that follows from it, and where in that step a walker is.

#include <optional>

#include <mobil/components/gait_style.h>
#include <mobil/components/lanes.h>
#include <mobil/components/step_shape.h>

namespace mobil::inline v0_3 {

/// What a caller asks of a walk. Speed (m/s), step length (m) and step frequency (steps/s): any two give the third;
/// one alone is completed by the step that people of that leg take at that speed (assets/gait); none means 5 km/h;
/// three must agree within 1 %. A speed of 0 asks to stand.
struct GaitRequest {
  std::optional<float> speed_m_s{}, step_length_m{}, step_frequency_hz{};
  GaitStyle style{};
};

/// What is to become otherwise of a walk: what is left out stays. Of speed, step length and step frequency those that
/// are given count alone, completed as in a GaitRequest.
struct GaitChange {
  std::optional<float> speed_m_s{}, step_length_m{}, step_frequency_hz{};
  std::optional<GaitStyle> style{};
};

/// A walk that was found consistent and within range, by `resolve_gait` (mobil/systems/gait/resolve_gait.h): what a
/// walker is to do. All zero but the style: to stand.
template <class F>
struct Gait {
  F speed_m_s, step_length_m, step_frequency_hz;  // the mean of right and left steps
  /// One double support as a fraction of the cycle of two steps.
  F double_support_cycle;
  F heading_rad;          // to turn to
  F left_m, ahead_m;      // to step aside and ahead, of who stands; once for each of:
  UInt32<F> displacement;  // tells one such step from the next
  UInt32<F> revision;      // tells one request from the next
  GaitStyleOf<F> style;
};

/// When in a step the pelvis turns, lists, tilts and shifts, φ the phase of the step from 0 at heel strike of the
/// stance leg to 1 at the next, from the first harmonics of Schwartz, Rozumalski & Trost 2008 (free speed). Seen from
/// the stance leg:
///   rotation (that side forward) = A cos π(φ − rotation)
///   list (that side up) = A (first cos π(φ − first phase) + third cos 3π(φ − third phase))
///   tilt (anterior) = mean + A cos 2π(φ − tilt)
/// The odd harmonics change sign from one step to the next as the sides change, so all are smooth through heel strike.
namespace pelvis_phase {
inline constexpr int rotation_1000 = 160, list_first_1000 = 272, list_third_1000 = 314, tilt_1000 = -166;
inline constexpr float rotation = rotation_1000 / 1000.0F;
inline constexpr float list_first = 0.70F, list_first_phase = list_first_1000 / 1000.0F;
inline constexpr float list_third = 0.30F, list_third_phase = list_third_1000 / 1000.0F;
inline constexpr float tilt = tilt_1000 / 1000.0F;
}  // namespace pelvis_phase

/// One double support in percent of the cycle: `at_rest` less `per_cadence` for each step a minute (at a height of 1.8
/// m) as Bruderlin & Calvert have it, through Schwartz (2008): 12, 10 and 8 % at slow, free and fast speed.
namespace double_support_law {
inline constexpr double at_rest = 23.6, per_cadence = 0.131, least = 6.0, most = 18.0;
}

/// Toes lie flat until the heel has risen by `from` (rad); from there on the foot rolls over their tips. By how much
/// the toes are pitched, for d = heel's rise − from: part · d³/(d² + within²). The tips stay where they are.
namespace toe_rocker {
inline constexpr float from = 0.35F, within = 0.40F, part = 0.7F;
}

/// A step at which the style's values hold, of body height.
inline constexpr double natural_step_h = 0.43;

/// How far arms swing, of what the style has at a natural step: by_speed · speed/√(g · leg), at most 1; and what they
/// follow: the opposite leg's line from hip to ankle from −reach_back to 1 times half a step over the leg.
namespace arm_swing {
inline constexpr double by_speed = 1.5, reach_back = 1.15;
}

/// After toe-off the toes, bent upward against the pitch of the foot, straighten between these parts of the swing.
namespace swing_toes {
inline constexpr float from = 0.25F, to = 0.85F;
}

/// The posture of a walk at a heel strike: amplitudes and postures that blend from one strike to the next. Angles rad.
template <class F>
struct PostureParameters {
  F pelvis_rotation, pelvis_list, pelvis_tilt, pelvis_tilt_wave;
  F shoulder_rotation, leg_back, leg_forward;  // range of the hip-to-ankle line, which the opposite arm follows
  F arm_back, arm_forward, elbow_back, elbow_forward, arm_abduction, forearm_pronation, finger_flexion;
};

/// How a walker is at a heel strike, the instant at which two steps meet. A function of body, gait, the speed before
/// and what was left to turn then (systems/gait/step_plan.cpp), so it is known before either step is solved. Standing
/// is a strike too, of length 0 and no speed. m, s, rad.
template <class F>
struct HeelStrike {
  F speed_m_s;                // of the gait that it belongs to; 0: standing
  F length_m;                 // from the trailing foothold to the leading one
  F pace_hz;                  // steps a second
  F advance_m;                // how far the hips go in a step at that pace
  F half_width_m, toe_out;    // of the leading foot
  F double_support;           // after it, of the cycle
  F own_style;                // how much of the style is the gait's own; the rest is the usual one
  F shape[step_shape::size];  // of a steady walk (mobil/components/step_shape.h), lengths in m
  PostureParameters<F> posture;
};

/// How many polynomials another way of the hips has.
inline constexpr std::size_t other_way_count = 5;

/// A polynomial of degree 5, its coefficients from the constant on.
template <class F>
struct Quintic {
  F coefficient[6];
};

/// One step of one individual, from the heel strike of its stance foot to the other's. Places relative to the stance
/// foothold, the point of the ground under the ankle when the foot is flat; z forward, y up, "out" away from the body's
/// middle on the leg's own side. Angles rad, lengths m, times s from heel strike.
///
/// The phase p goes from 0 to 1 over the step, at the pace of the strikes at either end. The numbers of both strikes'
/// shapes are mixed: those of `from` while both feet are on the ground, then with e(p) = 10 q³ − 15 q⁴ + 6 q⁵ (q the
/// part of single support that is over; of the whole step where it begins at rest) to those of `to`. All is twice
/// continuously differentiable, from step to step too.
template <class F>
struct StepPlan {
  F duration_s, double_support_s;    // of the step; of its first part on both feet
  F double_support, landing;         // phases at which the other foot leaves the ground and comes to it; both 0: stands
  F step_length_m, length_before_m;  // to the next foothold, from the one before
  F stride_part;                     // how far the other foot swings, of what the strikes' walks do
  F mixed_from;                      // phase from which on the shapes are mixed
  F phase_rate_from, phase_rate_to;  // of the phase of the step over the time as a part of the step
  F trailing_half_width_m, trailing_toe_out;
  F slant_rad;                      // of who stands: the heading of a step aside, beside the way the body faces
  UInt32<F> swaps;                  // 1: of who stands, the other foot becomes the stance foot as this step begins
  UInt32<F> displacement, revision;  // of the gait that it was solved for
  UInt32<F> settled;                 // 1: the next step is this one mirrored, as long as the gait stays
  UInt32<F> clamped;                 // 1: the centre of pressure that this step asks for lies beyond the soles
  HeelStrike<F> from, to;
  Quintic<F> even_m;  // by p: the hips' way without what is periodic
  /// The other foot from toe-off to heel strike, by the part of the swing: its pitch and its ankle's place relative to
  /// the stance foothold, without the bumps of its shape.
  Quintic<F> swing_pitch, swing_forward_m, swing_up_m, swing_out_m;
  /// What the other foot's ankle has beside those bumps where its swing is integrated forward (style: forward_swing),
  /// as 64 u³(1 − u)³ times Legendre polynomials of 2u − 1, u the part of the swing.
  F swing_by_forward_m[other_way_count], swing_by_up_m[other_way_count];
  /// Where the strikes differ the hips go another way by 64 u³(1 − u)³ times Legendre polynomials of 2u − 1, u the part
  /// of the step's time: forward, and toward the stance foot.
  F ahead_m[other_way_count], aside_m[other_way_count];
};

/// Where a walker is: time since heel strike of the stance foot (0 right, 1 left), steps taken, and the point of the
/// walking line beside the stance foothold with the line's heading there: about +Y, 0 toward +Z, positive to the left;
/// where the straight line began that the walker follows (`anchor`), and with which step; how much the line turns to
/// the next foothold and how much it turned from the one before, and the headings of the straight ways to and from them
/// beside that of the line. Footholds lie beside the line; in a turn they are all moved by a shift, to the left of it,
/// so that the ground can push the body inward, and the line has one curvature for as long as one foot bears
/// (assets/gait/walking_line-inl.h). All zero: right heel strike at the origin, walking toward +Z.
template <class F>
struct GaitState {
  F time_s;
  UInt32<F> stance_side, steps;
  F line_x_m, line_z_m, heading_rad;
  F anchor_x_m, anchor_z_m;
  UInt32<F> anchor_steps;
  F turn_rad, turn_before_rad, chord_rad, chord_before_rad;
  F bend_per_m, bend_before_per_m, bend_next_per_m;  // curvature on the stance foot, the one before and the next
  F shift_m, shift_before_m, shift_next_m;           // of the stance foothold, of the one before and of the next
};

}  // namespace mobil::inline v0_3
