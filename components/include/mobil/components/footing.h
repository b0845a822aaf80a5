#pragma once
// The ground under a walker's feet, where it is not the level plane y = 0: state like any other, on the person's row.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// A step's footholds: that which the other foot leaves, the stance foot's, that which the other foot comes to.
enum class FootholdOf : std::uint8_t { leaving, stance, landing };
constexpr std::size_t index(FootholdOf which) {
  return static_cast<std::size_t>(which);
}

/// By FootholdOf: the height of the ground in the world, m; how much it rises toward +X and +Z, m per m; how far the
/// foothold is moved in the world from where it would be on level ground, m, so that no edge is under the sole.
/// `lift_early_m`, `lift_late_m`: how much higher than straight from one foothold to the next the foot in the air
/// passes (`swing_lift`). Where the stance foothold and the next one were when the ground was asked for, before they
/// were moved; the step (GaitState) that it is of; and how much of it is known (FootingKnown). The steepness for which
/// the walker is to slow down, m per m, 0: for none. The request (Gait::revision) that was last looked at for it; where
/// that is the gait's own and `level_speed_m_s` is not 0, the gait is a slowed one, and the speed and the length of
/// step are those asked for on level ground. All zero: level ground, nothing known yet.
template <class F>
struct Footing {
  F height_m[3], rise_x[3], rise_z[3];
  F moved_x_m[3], moved_z_m[3];
  F lift_early_m, lift_late_m;
  F stance_x_m, stance_z_m, landing_x_m, landing_z_m;
  UInt32<F> steps, stance_side, known;
  F slows_for, level_speed_m_s, level_length_m;
  UInt32<F> looked_at;
};

/// All that is kept by FootholdOf.
template <class F>
std::array<F (*)[3], 5> by_foothold(Footing<F>& footing) {
  return {&footing.height_m, &footing.rise_x, &footing.rise_z, &footing.moved_x_m, &footing.moved_z_m};
}

/// Parts of the swing's time at which a foot's early and its late lift are greatest: each rises until then and falls
/// from then on as 10 u³ − 15 u⁴ + 6 u⁵.
namespace swing_lift {
inline constexpr float early = 0.35F, late = 0.70F;
}

/// Nothing; the ground of the step before, that the stance foot has come to; all.
enum FootingKnown : unsigned { footing_unknown = 0, footing_before = 1, footing_all = 2 };

}  // namespace mobil::inline v0_3
