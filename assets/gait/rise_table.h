#pragma once
// How steps up and down differ from level ones.

#include <cstddef>

namespace mobil::inline v0_3::rise_table {

enum Number : std::size_t {
  trunk_lean,      // rad
  strike_less,     // part of the pitch, toes up, that a foot does not land with
  toes_first,      // pitch, toes down, that it lands with instead, rad
  heel_up_more,    // pitch, heel up, with which the foot leaves the ground that the other has stepped from it, rad
  hips_up,         // at the strike, over the lower of both feet, beside level ground; in body heights, as all lengths
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

/// The steepness, rise over length of a step, for which the numbers are: that of stairs. Parts of it up to which a step
/// is that of a slope, which changes little but the lean of the trunk, and from which on it is that of stairs.
inline constexpr float full = 0.16F / 0.30F, gentle = 0.25F, stairs = 0.85F;
/// A heel rises as much as on stairs where the ground falls so far beside its slope, of the height; and by so much more
/// the further its step is than one on stairs, both of the height.
inline constexpr float edge_h = 0.085F, stairs_h = 0.22F, edge_further = 1.5F;
/// Steps that are shorter count as that long, of the height.
inline constexpr float shortest_h = 0.1F;
/// How much higher the hips pass over the leg that bears than straight from strike to strike, of the rise.
inline constexpr float vault = 0.3F;
/// Over this part of the cycle a foot that landed toes first comes flat.
inline constexpr float toes_first_part = 0.12F;
/// A heel that rises more begins to at this part of the cycle.
inline constexpr float heel_up_from = 0.25F;

/// How much of the rise from one foothold to the next the hips rise at a strike, of a step's phase, up and down: on a
/// gentle slope.
inline constexpr float gentle_rate[2] = {0.35F, 0.8F};

/// The same where it is that steep; up, then down.
inline constexpr float rate[2] = {0.955F, 1.594F};
inline constexpr float numbers[2][count] = {{0.12F, -0.011F, 0.164F, 0.129F, 0.0047F, -0.0221F, 0.0465F, -0.0321F,
                                             -0.0050F, 0.0490F, -0.371F, -0.388F, -0.245F, -0.139F},
                                            {0.03F, 1.289F, 0.506F, 0.334F, 0.0340F, -0.0315F, 0.0263F, 0.0671F,
                                             -0.0276F, -0.0081F, -0.853F, -0.986F, -0.123F, -0.124F}};

}  // namespace mobil::inline v0_3::rise_table
