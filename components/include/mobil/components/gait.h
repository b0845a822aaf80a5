#pragma once
// The walk of a person: the request, with one table of style parameters that programs and documents share; the solved
// gait; and the walker's position.

#include <array>
#include <optional>
#include <string_view>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Returns a field's default for one row or for sixteen.
template <class F>
constexpr F in_every_lane(float value) {
  if constexpr (std::is_same_v<F, Lanes<float>>) {
    F lanes{};
    for (auto& lane : lanes.lane) lane = value;
    return lanes;
  } else {
    return F(value);
  }
}

/// Units are in the names: _deg degrees; _h fractions of body height; _cycle fractions of the gait cycle of two steps.
/// Values that depend on speed are given at a natural step (0.43 body heights) and scaled from there. `gait_parameters`
/// has meaning, default and range of each.
template <class F>
struct GaitStyleOf {
  F pelvis_rotation_deg = in_every_lane<F>(6.5F);
  F pelvis_list_deg = in_every_lane<F>(4.0F);
  F pelvis_shift_h = in_every_lane<F>(0.0125F);
  F pelvis_tilt_deg = in_every_lane<F>(10.0F);
  F pelvis_tilt_wave_deg = in_every_lane<F>(0.8F);
  F step_width_h = in_every_lane<F>(0.055F);
  F toe_out_deg = in_every_lane<F>(6.0F);
  F step_asymmetry = in_every_lane<F>(0.0F);
  F time_asymmetry = in_every_lane<F>(0.0F);
  F double_support_scale = in_every_lane<F>(1.0F);
  F strike_pitch_deg = in_every_lane<F>(22.0F);
  F strike_knee_deg = in_every_lane<F>(4.5F);
  F foot_flat_cycle = in_every_lane<F>(0.1066F);
  F stance_knee_deg = in_every_lane<F>(4.1F);
  F toe_off_knee_deg = in_every_lane<F>(33.35F);
  F knee_release_cycle = in_every_lane<F>(0.443F);
  F swing_knee_deg = in_every_lane<F>(47.0F);
  F swing_ankle_deg = in_every_lane<F>(-0.8F);
  F toe_clearance_m = in_every_lane<F>(0.012F);
  F foot_pivot_h = in_every_lane<F>(0.0106F);
  F mid_stance_height = in_every_lane<F>(0.9995F);
  F hip_fall = in_every_lane<F>(0.3F);
  F leg_stiffness_n_per_m = in_every_lane<F>(16000.0F);
  F leg_damping = in_every_lane<F>(0.40F);
  F roll_over = in_every_lane<F>(0.57F);
  F forward_swing = in_every_lane<F>(0.0F);
  F trunk_lean_deg = in_every_lane<F>(2.0F);
  F trunk_stiffness = in_every_lane<F>(8.0F);
  F shoulder_rotation = in_every_lane<F>(1.0F);
  F arm_back_deg = in_every_lane<F>(18.0F);
  F arm_forward_deg = in_every_lane<F>(16.0F);
  F elbow_back_deg = in_every_lane<F>(10.0F);
  F elbow_forward_deg = in_every_lane<F>(35.0F);
  F arm_abduction_deg = in_every_lane<F>(6.0F);
  F forearm_pronation_deg = in_every_lane<F>(65.0F);
  F finger_flexion_deg = in_every_lane<F>(25.0F);
};

/// One person's style.
using GaitStyle = GaitStyleOf<float>;

/// A request for a walk. Any two of speed (m/s), step length (m) and step frequency (steps/s) determine the third. If
/// only one is set, the others are those of people of that leg length and age in shoes (mobil/usual_gait.h). If none is
/// set, the speed is 5 km/h. `usual_style` and `usual_speed_m_s` (mobil/usual_gait.h) return those of a sex and age. Three must agree within 1 %. A speed of 0 requests standing.
struct GaitRequest {
  std::optional<float> speed_m_s{}, step_length_m{}, step_frequency_hz{};
  GaitStyle style{};
};

/// A partial change of gait. Unset fields keep their value. If any of speed, step length and step frequency is set,
/// only the set ones count; they are completed as in a GaitRequest.
struct GaitChange {
  std::optional<float> speed_m_s{}, step_length_m{}, step_frequency_hz{};
  std::optional<GaitStyle> style{};
};

/// One parameter: name, unit ("1" if dimensionless), member, range, and meaning.
struct GaitParameter {
  std::string_view name, unit;
  float GaitStyle::*value;
  float low, high;
  std::string_view meaning;
};

/// All parameters of a style, in the order of its fields. The command line, the C interface and snapshots use these
/// names.
inline constexpr std::array<GaitParameter, 36> gait_parameters = {{
    {"pelvis_rotation_deg", "deg", &GaitStyle::pelvis_rotation_deg, 0, 15, "pelvis turn to each side (transverse)"},
    {"pelvis_list_deg", "deg", &GaitStyle::pelvis_list_deg, 0, 10, "pelvis list to each side (frontal)"},
    {"pelvis_shift_h", "height", &GaitStyle::pelvis_shift_h, 0, 0.03F, "pelvis shift toward the stance foot"},
    {"pelvis_tilt_deg", "deg", &GaitStyle::pelvis_tilt_deg, -10, 20, "mean anterior tilt of the pelvis"},
    {"pelvis_tilt_wave_deg", "deg", &GaitStyle::pelvis_tilt_wave_deg, 0, 5,
     "rise and fall of that tilt, twice a cycle"},
    {"step_width_h", "height", &GaitStyle::step_width_h, 0.02F, 0.15F, "distance between the lines of the two ankles"},
    {"toe_out_deg", "deg", &GaitStyle::toe_out_deg, -15, 30, "feet turned outward"},
    {"step_asymmetry", "1", &GaitStyle::step_asymmetry, -0.4F, 0.4F, "right step longer than the mean by this part"},
    {"time_asymmetry", "1", &GaitStyle::time_asymmetry, -0.3F, 0.3F, "right step slower than the mean by this part"},
    {"double_support_scale", "1", &GaitStyle::double_support_scale, 0.6F, 1.5F,
     "double support, of what the cadence asks"},
    {"strike_pitch_deg", "deg", &GaitStyle::strike_pitch_deg, 10, 30, "foot at heel strike, toes up"},
    {"strike_knee_deg", "deg", &GaitStyle::strike_knee_deg, 2, 20, "knee flexion at heel strike"},
    {"foot_flat_cycle", "cycle", &GaitStyle::foot_flat_cycle, 0.04F, 0.15F, "heel strike to foot flat"},
    {"stance_knee_deg", "deg", &GaitStyle::stance_knee_deg, 4, 20, "least knee flexion before the heel rises"},
    {"toe_off_knee_deg", "deg", &GaitStyle::toe_off_knee_deg, 20, 50, "knee flexion at toe-off"},
    {"knee_release_cycle", "cycle", &GaitStyle::knee_release_cycle, 0.41F, 0.47F, "when the trailing knee yields"},
    {"swing_knee_deg", "deg", &GaitStyle::swing_knee_deg, 30, 75,
     "greatest knee flexion in swing, before the foot is lifted"},
    {"swing_ankle_deg", "deg", &GaitStyle::swing_ankle_deg, -12, 10, "dorsiflexion in mid-swing"},
    {"toe_clearance_m", "m", &GaitStyle::toe_clearance_m, 0, 0.06F, "height of the toe over the ground in mid-swing"},
    {"foot_pivot_h", "height", &GaitStyle::foot_pivot_h, -0.01F, 0.03F,
     "centre of pressure ahead of the ankle, mean, on one foot"},
    {"mid_stance_height", "1", &GaitStyle::mid_stance_height, 0.90F, 1, "hip height in mid-stance, of standing"},
    {"hip_fall", "1", &GaitStyle::hip_fall, 0.1F, 0.35F, "fall of the hips to double support, of straight legs'"},
    {"leg_stiffness_n_per_m", "N/m", &GaitStyle::leg_stiffness_n_per_m, 8000, 60000, "leg spring at a height of 1.8 m"},
    {"leg_damping", "1", &GaitStyle::leg_damping, 0.2F, 1,
     "of the loaded knee, of critical: the more, the less it bends"},
    {"roll_over", "1", &GaitStyle::roll_over, 0.4F, 0.7F,
     "travel of the centre of pressure, of the hips', on one foot"},
    {"forward_swing", "1", &GaitStyle::forward_swing, 0, 1, "share of the swing that torques at hip and knee make"},
    {"trunk_lean_deg", "deg", &GaitStyle::trunk_lean_deg, -8, 12, "mean forward lean of the trunk"},
    {"trunk_stiffness", "1", &GaitStyle::trunk_stiffness, 2, 20,
     "of the trunk, of its toppling stiffness: against swaying"},
    {"shoulder_rotation", "1", &GaitStyle::shoulder_rotation, 0, 2, "shoulders against the pelvis, times its rotation"},
    {"arm_back_deg", "deg", &GaitStyle::arm_back_deg, 0, 50, "arm swing backward"},
    {"arm_forward_deg", "deg", &GaitStyle::arm_forward_deg, 0, 60, "arm swing forward"},
    {"elbow_back_deg", "deg", &GaitStyle::elbow_back_deg, 0, 100, "elbow flexion when the arm is back"},
    {"elbow_forward_deg", "deg", &GaitStyle::elbow_forward_deg, 0, 120, "elbow flexion when the arm is forward"},
    {"arm_abduction_deg", "deg", &GaitStyle::arm_abduction_deg, 0, 30, "arms held away from the trunk"},
    {"forearm_pronation_deg", "deg", &GaitStyle::forearm_pronation_deg, 0, 90,
     "forearms turned inward, palms to the thighs"},
    {"finger_flexion_deg", "deg", &GaitStyle::finger_flexion_deg, 0, 90, "fingers bent"},
}};

/// A walk whose values agree and are in range, as `resolve_gait` returns it (mobil/systems/gait/resolve_gait.h). If all
/// values except the style are zero, the walker stands.
template <class F>
struct Gait {
  F speed_m_s, step_length_m, step_frequency_hz;  // averages over right and left steps
  /// One double support as a fraction of the cycle of two steps.
  F double_support_cycle;
  F heading_rad;           // target heading
  F left_m, ahead_m;       // step of a standing walker to the left and ahead
  UInt32<F> displacement;  // counts requests of such steps; each is taken once
  UInt32<F> revision;      // counts requests for a gait
  GaitStyleOf<F> style;
};

/// Position of a walker. `time_s`: time since heel strike of the stance foot (0 right, 1 left). The walking line is the
/// path between the footholds along which the walker advances. `line_x_m`, `line_z_m`, `heading_rad`: its point next to
/// the stance foothold, and its heading there (about +Y, 0 toward +Z, positive to the left). `anchor`: point at which
/// the present straight part of the line began, and the value of `steps` there. `turn`: change of the line's heading
/// from the stance foothold to the next one, and from the one before to the stance foothold. `chord`: heading of the
/// straight line between the same footholds, relative to the walking line at the stance foothold. In a turn each
/// foothold is displaced to the left of the line by `shift` (negative: right). The ground can then push the body
/// inward. The line's curvature is constant while one foot bears load (assets/gait/walking_line-inl.h). All zero: right
/// heel strike, origin, +Z.
template <class F>
struct GaitState {
  F time_s;
  UInt32<F> stance_side, steps;
  F line_x_m, line_z_m, heading_rad;
  F anchor_x_m, anchor_z_m;
  UInt32<F> anchor_steps;
  F turn_rad, turn_before_rad, chord_rad, chord_before_rad;
  F bend_per_m, bend_before_per_m, bend_next_per_m;  // curvature at the stance foot, the one before and the next
  F shift_m, shift_before_m, shift_next_m;           // of the stance foothold, the one before and the next
};

}  // namespace mobil::inline v0_3
