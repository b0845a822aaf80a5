#pragma once
// How someone walks: what is asked for, the solved step that follows from it, and where in that step a walker is.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "components/lanes.h"

namespace mobil {

/// The parameters that tell one walker from another. Angles in degrees; lengths in fractions of body height where the
/// name says _h; each has its range in `gait_parameters`.
struct GaitStyle {
  float pelvis_rotation_deg = 4.5F;  // to each side, transverse plane
  float pelvis_list_deg = 4.0F;      // to each side, frontal plane
  float pelvis_shift_h = 0.0125F;    // toward the stance foot
  float pelvis_tilt_deg = 3.0F;      // mean, anterior
  float pelvis_tilt_wave_deg = 0.8F;
  float step_width_h = 0.055F;  // between the ankles' lines
  float toe_out_deg = 6.0F;
  float strike_pitch_deg = 20.0F;  // toes up at heel strike
  float strike_knee_deg = 7.0F;
  float foot_flat_cycle = 0.08F;  // of the cycle, from heel strike
  float stance_knee_deg = 8.0F;   // least flexion before the heel rises
  float toe_off_knee_deg = 31.0F;
  float knee_release_cycle = 0.37F;  // when the trailing knee starts to yield
  float swing_knee_deg = 52.0F;      // greatest flexion asked of the swing, before the foot is lifted
  float swing_ankle_deg = 3.0F;      // dorsiflexion in mid-swing
  float toe_clearance_m = 0.012F;
  float foot_pivot_h = 0.012F;             // support pivot ahead of the ankle
  float mid_stance_height = 0.995F;        // hip over the ground in mid-stance, of its standing height
  float hip_fall = 0.47F;                  // fall of the hip toward double support, of a stiff leg's
  float leg_stiffness_n_per_m = 16000.0F;  // at 1.8 m; the same for light and heavy people
  float leg_damping = 0.40F;               // of critical
  float roll_over = 0.35F;                 // travel of the centre of pressure, of the hip's
  float double_support_scale = 1.0F;
  float trunk_lean_deg = 2.0F;
  float trunk_stiffness = 3.0F;    // of the trunk's toppling stiffness
  float shoulder_rotation = 1.0F;  // against the pelvis, times its rotation
  float arm_back_deg = 18.0F, arm_forward_deg = 16.0F;
  float elbow_back_deg = 10.0F, elbow_forward_deg = 35.0F;
  float arm_abduction_deg = 6.0F;
  float forearm_pronation_deg = 65.0F;
  float finger_flexion_deg = 25.0F;
};

/// A parameter by name: where it lies in GaitStyle and its range.
struct GaitParameter {
  std::string_view name;
  float GaitStyle::*value;
  float low, high;
};

inline constexpr std::array<GaitParameter, 33> gait_parameters = {{
    {"pelvis_rotation_deg", &GaitStyle::pelvis_rotation_deg, 0.0F, 15.0F},
    {"pelvis_list_deg", &GaitStyle::pelvis_list_deg, 0.0F, 10.0F},
    {"pelvis_shift_h", &GaitStyle::pelvis_shift_h, 0.0F, 0.03F},
    {"pelvis_tilt_deg", &GaitStyle::pelvis_tilt_deg, -10.0F, 20.0F},
    {"pelvis_tilt_wave_deg", &GaitStyle::pelvis_tilt_wave_deg, 0.0F, 5.0F},
    {"step_width_h", &GaitStyle::step_width_h, 0.02F, 0.15F},
    {"toe_out_deg", &GaitStyle::toe_out_deg, -15.0F, 30.0F},
    {"strike_pitch_deg", &GaitStyle::strike_pitch_deg, 2.0F, 30.0F},
    {"strike_knee_deg", &GaitStyle::strike_knee_deg, 2.0F, 30.0F},
    {"foot_flat_cycle", &GaitStyle::foot_flat_cycle, 0.04F, 0.15F},
    {"stance_knee_deg", &GaitStyle::stance_knee_deg, 4.0F, 30.0F},
    {"toe_off_knee_deg", &GaitStyle::toe_off_knee_deg, 10.0F, 60.0F},
    {"knee_release_cycle", &GaitStyle::knee_release_cycle, 0.30F, 0.48F},
    {"swing_knee_deg", &GaitStyle::swing_knee_deg, 30.0F, 100.0F},
    {"swing_ankle_deg", &GaitStyle::swing_ankle_deg, -15.0F, 15.0F},
    {"toe_clearance_m", &GaitStyle::toe_clearance_m, 0.0F, 0.10F},
    {"foot_pivot_h", &GaitStyle::foot_pivot_h, -0.02F, 0.06F},
    {"mid_stance_height", &GaitStyle::mid_stance_height, 0.90F, 1.0F},
    {"hip_fall", &GaitStyle::hip_fall, 0.2F, 1.0F},
    {"leg_stiffness_n_per_m", &GaitStyle::leg_stiffness_n_per_m, 8000.0F, 60000.0F},
    {"leg_damping", &GaitStyle::leg_damping, 0.2F, 1.0F},
    {"roll_over", &GaitStyle::roll_over, 0.0F, 0.7F},
    {"double_support_scale", &GaitStyle::double_support_scale, 0.6F, 1.5F},
    {"trunk_lean_deg", &GaitStyle::trunk_lean_deg, -5.0F, 15.0F},
    {"trunk_stiffness", &GaitStyle::trunk_stiffness, 1.5F, 10.0F},
    {"shoulder_rotation", &GaitStyle::shoulder_rotation, 0.0F, 2.0F},
    {"arm_back_deg", &GaitStyle::arm_back_deg, 0.0F, 50.0F},
    {"arm_forward_deg", &GaitStyle::arm_forward_deg, 0.0F, 60.0F},
    {"elbow_back_deg", &GaitStyle::elbow_back_deg, 0.0F, 100.0F},
    {"elbow_forward_deg", &GaitStyle::elbow_forward_deg, 0.0F, 120.0F},
    {"arm_abduction_deg", &GaitStyle::arm_abduction_deg, 0.0F, 30.0F},
    {"forearm_pronation_deg", &GaitStyle::forearm_pronation_deg, 0.0F, 90.0F},
    {"finger_flexion_deg", &GaitStyle::finger_flexion_deg, 0.0F, 90.0F},
}};

/// What a caller asks of a walk. Speed (m/s), step length (m) and step frequency (steps/s): any two give the third;
/// one alone is completed by step length = 0.004 · steps per minute · height (Bruderlin & Calvert); none means 5 km/h;
/// three must agree within 1 %.
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
