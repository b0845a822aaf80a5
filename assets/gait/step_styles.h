#pragma once
// Changes of the table's steps with the posture of a walk; see README.md in this folder.

#include <array>
#include <string_view>

#include <mobil/components/gait.h>
#include "assets/gait/step_table.h"

namespace mobil::inline v0_3 {

/// A parameter of a walk, and the unit of its effect on the step: deg, parts of the cycle, m, or a part of the usual
/// value.
struct StyleEffect {
  float GaitStyle::*parameter;
  std::string_view what;
};

inline constexpr std::array<StyleEffect, 14> style_effects = {{
    {&GaitStyle::strike_pitch_deg, "deg: pitch of the foot at heel strike"},
    {&GaitStyle::strike_knee_deg, "deg: knee at heel strike"},
    {&GaitStyle::stance_knee_deg, "deg: least knee flexion in single support"},
    {&GaitStyle::toe_off_knee_deg, "deg: knee at toe-off"},
    {&GaitStyle::knee_release_cycle, "cycle: when the trailing knee passes its usual angle of 0.53"},
    {&GaitStyle::swing_knee_deg, "deg: greatest knee flexion in swing"},
    {&GaitStyle::swing_ankle_deg, "deg: ankle in mid-swing"},
    {&GaitStyle::toe_clearance_m, "m at a height of 1.75 m: toe over the ground in mid-swing"},
    {&GaitStyle::foot_pivot_h, "height: mean centre of pressure in single support, ahead of the ankle"},
    {&GaitStyle::hip_fall, "fall of the hips, of that of straight legs"},
    {&GaitStyle::leg_damping, "flexion of the loaded knee, of the usual one"},
    {&GaitStyle::roll_over, "travel of the centre of pressure in single support, of the hips' travel"},
    {&GaitStyle::trunk_lean_deg, "deg: mean lean of the trunk"},
    {&GaitStyle::trunk_stiffness, "sway of the trunk, of the usual one"},
}};

/// Changes of a usual step's shape by one unit of each, of a body of height 1 m (so lengths are as in TabledShape).
extern const std::array<std::array<TabledShape, style_effects.size()>, step_table::speed_count> step_styles;

}  // namespace mobil::inline v0_3
