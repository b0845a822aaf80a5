#pragma once
// A solved step of a walker, and constants of its curves.

#include <cstddef>

#include <mobil/components/lanes.h>
#include <mobil/components/step_shape.h>

namespace mobil::inline v0_3 {

/// Timing of the pelvis' rotation, list and tilt. φ is the phase of the step, 0 at heel strike of the stance leg and 1
/// at the next strike. The numbers are the first harmonics of curves by Schwartz, Rozumalski & Trost 2008 (free speed).
/// "That side" is the side of the stance leg; A is the amplitude:
///   rotation (that side forward) = A cos π(φ − rotation);
///   list (that side up) = A (first cos π(φ − first phase) + third cos 3π(φ − third phase));
///   tilt (anterior) = mean + A cos 2π(φ − tilt).
/// Rotation and list have odd harmonics only, which change sign when the stance side changes. All curves are therefore
/// smooth through heel strike.
namespace pelvis_phase {
inline constexpr int rotation_1000 = 160, list_first_1000 = 272, list_third_1000 = 314, tilt_1000 = -166;
inline constexpr float rotation = rotation_1000 / 1000.0F;
inline constexpr float list_first = 0.70F, list_first_phase = list_first_1000 / 1000.0F;
inline constexpr float list_third = 0.30F, list_third_phase = list_third_1000 / 1000.0F;
inline constexpr float tilt = tilt_1000 / 1000.0F;
}  // namespace pelvis_phase

/// Duration of one double support, % of the cycle: `at_rest` − `per_cadence` · steps a minute of a body of 1.8 m. The
/// law is from Bruderlin & Calvert. Its numbers are fitted to Schwartz (2008): 12, 10 and 8 % at slow, free and fast
/// speed.
namespace double_support_law {
inline constexpr double at_rest = 23.6, per_cadence = 0.131, least = 6.0, most = 18.0;
}

/// Toes are flat until the foot is pitched by `from` (rad, heel up). The foot then rolls over the tips of the toes,
/// which stay in place. With d = pitch − from, the toes are pitched by part · d³/(d² + within²).
namespace toe_rocker {
inline constexpr float from = 0.35F, within = 0.40F, part = 0.7F;
}

/// Step length, relative to body height, to which the values of a style refer.
inline constexpr double natural_step_h = 0.43;

/// Arm swing. For a step of natural length its amplitude is that of the style times by_speed · speed/√(g · leg), at
/// most 1. An arm follows the direction of the opposite leg's line from hip to ankle. The range of that direction is
/// −reach_back to 1, times half a step length over the leg length.
namespace arm_swing {
inline constexpr double by_speed = 1.5, reach_back = 1.15;
}

/// Fractions of the swing between which the toes straighten. At toe-off they are bent upward relative to the foot.
namespace swing_toes {
inline constexpr float from = 0.25F, to = 0.85F;
}

/// Posture parameters at a heel strike: amplitudes and angles that are blended from one strike to the next. Angles rad.
template <class F>
struct PostureParameters {
  F pelvis_rotation, pelvis_list, pelvis_tilt, pelvis_tilt_wave;
  F shoulder_rotation, leg_back, leg_forward;  // range of the hip-to-ankle line, which the opposite arm follows
  F arm_back, arm_forward, elbow_back, elbow_forward, arm_abduction, forearm_pronation, finger_flexion;
};

/// State of a walker at a heel strike, the instant at which two steps meet. It is a function of body, gait, the speed
/// before, and the remaining turn (systems/gait/step_plan.cpp), so it is known before either step is solved. Standing
/// is a strike of length 0 and speed 0. m, s, rad.
template <class F>
struct HeelStrike {
  F speed_m_s;                // of the gait in which the foot strikes; 0: standing
  F length_m;                 // from the trailing foothold to the leading one
  F pace_hz;                  // steps a second
  F advance_m;                // advance of the hips in a step at that pace
  F half_width_m, toe_out;    // of the leading foot
  F double_support;           // that follows, as a fraction of the cycle
  F own_style;                // share of the gait's style, 0 to 1; the rest is the usual style
  F shape[step_shape::size];  // of a steady walk (mobil/components/step_shape.h), lengths in m
  PostureParameters<F> posture;
};

/// Number of polynomials by which the hips' path is corrected.
inline constexpr std::size_t other_way_count = 5;

/// A polynomial of degree 5, with coefficients from the constant upward.
template <class F>
struct Quintic {
  F coefficient[6];
};

/// One step of one walker, from the heel strike of its stance foot to the other's. Positions are relative to the stance
/// foothold, the point of the ground under the ankle when the foot is flat. z is forward, y up, "out" away from the
/// body's middle on the leg's own side. Angles rad, lengths m, times s from heel strike.
///
/// The phase p rises from 0 to 1 over the step; at each end its rate is the pace of that strike. The shapes of both
/// strikes are blended. In double support the shape is that of `from`. After it, the share of `to` is e(p) = 10 q³ − 15
/// q⁴ + 6 q⁵. The elapsed part of single support is q = (p − mixed_from)/(1 − mixed_from). In a step that starts at
/// rest `mixed_from` is 0, so the shapes are blended over the whole step. All curves are twice continuously
/// differentiable, also across steps.
template <class F>
struct StepPlan {
  F duration_s, double_support_s;    // of the step; of its first part on both feet
  F double_support, landing;         // phases of the other foot's toe-off and heel strike; both 0: stands
  F step_length_m, length_before_m;  // to the next foothold, from the one before
  F stride_part;                     // swing length relative to the steady walks of both strikes
  F mixed_from;                      // phase at which blending of the shapes begins
  F phase_rate_from, phase_rate_to;  // rate of the phase, per fraction of the step's time
  F trailing_half_width_m, trailing_toe_out;
  F slant_rad;                       // heading of a standing walker's step aside, relative to the body
  UInt32<F> swaps;                   // 1: a standing walker's other foot becomes the stance foot at the start
  UInt32<F> displacement, revision;  // of the gait for which it was solved
  UInt32<F> settled;                 // 1: the next step mirrors this one while the gait is unchanged
  UInt32<F> clamped;                 // 1: centre of pressure outside the soles by over 4 % of height
  HeelStrike<F> from, to;
  Quintic<F> even_m;  // forward path of the hips by p, without its periodic part
  /// The swing foot from toe-off to heel strike, by the fraction of the swing: its pitch and its ankle's position
  /// relative to the stance foothold, without the bumps of its shape.
  Quintic<F> swing_pitch, swing_forward_m, swing_up_m, swing_out_m;
  /// Correction of the swing ankle, added to those bumps if the swing is computed from joint torques (style:
  /// forward_swing). Its terms are 64 u³(1 − u)³ times Legendre polynomials of 2u − 1, with u the fraction of the
  /// swing.
  F swing_by_forward_m[other_way_count], swing_by_up_m[other_way_count];
  /// Correction of the hips' path if the strikes differ: forward, and toward the stance foot. Its terms are
  /// 64 u³(1 − u)³ times Legendre polynomials of 2u − 1, with u the fraction of the step's time.
  F ahead_m[other_way_count], aside_m[other_way_count];
};

}  // namespace mobil::inline v0_3
