#pragma once
// Differences of steps up and down from level ones.

#include <cstddef>

namespace mobil::inline v0_3::rise_table {

enum Number : std::size_t {
  trunk_lean,      // rad
  strike_less,     // part of the toes-up pitch that a landing foot lacks
  toes_first,      // toes-down pitch of a landing foot instead, rad
  heel_up_more,    // additional heel-up pitch with which a foot leaves the ground after a step from it, rad
  hips_up,         // at the strike, above the lower foot, relative to level ground; in body heights, as all lengths
  hips_up_middle,  // bumps over the step
  hips_up_late,
  hips_ahead,  // at the strike
  hips_ahead_middle,
  hips_ahead_late,
  swing_pitch,  // bumps over the swing
  swing_pitch_late,
  swing_ahead,
  swing_ahead_late,
  count
};

/// Steepness, rise over length of a step, for which the numbers are: that of stairs. A step up to `gentle` of it is
/// that of a slope, which changes little except for the trunk's lean; from `stairs` of it, a step is that of stairs.
inline constexpr float full = 0.16F / 0.30F, gentle = 0.25F, stairs = 0.85F;
/// A heel rises as much as on stairs where the ground falls by `edge_h` below its slope. It rises by `edge_further`
/// more per length of its step beyond `stairs_h`, the one on stairs. Both are of the height.
inline constexpr float edge_h = 0.085F, stairs_h = 0.22F, edge_further = 1.5F;
/// Minimum step length in these rules, of the height.
inline constexpr float shortest_h = 0.1F;
/// Extra height of the hips over the bearing leg, above the straight line from strike to strike, of the rise.
inline constexpr float vault = 0.3F;
/// Part of the cycle over which a foot that landed toes first becomes flat.
inline constexpr float toes_first_part = 0.12F;
/// Part of the cycle at which a heel starts to rise more.
inline constexpr float heel_up_from = 0.25F;

/// Rate of the hips' rise at a strike, over the rise from one foothold to the next and per step phase, up and down: on
/// a gentle slope.
inline constexpr float gentle_rate[2] = {0.35F, 0.8F};

/// The rate at full steepness; up, then down.
inline constexpr float rate[2] = {0.955F, 1.594F};
inline constexpr float numbers[2][count] = {{0.12F, -0.011F, 0.164F, 0.129F, 0.0047F, -0.0221F, 0.0465F, -0.0321F,
                                             -0.0050F, 0.0490F, -0.371F, -0.388F, -0.245F, -0.139F},
                                            {0.03F, 1.289F, 0.506F, 0.334F, 0.0340F, -0.0315F, 0.0263F, 0.0671F,
                                             -0.0276F, -0.0081F, -0.853F, -0.986F, -0.123F, -0.124F}};

}  // namespace mobil::inline v0_3::rise_table
