#pragma once
// Ground under a walker's feet that differs from the level plane y = 0. It is stored on the person's row.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Footholds of a step: the one that the swing foot leaves, the stance foot's, and the one where the swing foot lands.
enum class FootholdOf : std::uint8_t { leaving, stance, landing };
constexpr std::size_t index(FootholdOf which) {
  return static_cast<std::size_t>(which);
}

/// Ground of a step, indexed by FootholdOf. `height_m`: height in the world. `rise_x`, `rise_z`: slope toward +X and
/// +Z, m per m. `moved_x_m`, `moved_z_m`: offset in the world from the foothold on level ground, so that no edge is
/// under the sole. `lift_early_m`, `lift_late_m`: height of the swing foot above the straight path between footholds
/// (`swing_lift`). `stance_x_m` to `landing_z_m`: both footholds at the time of the query, without offsets. `steps`,
/// `stance_side`: the step (GaitState) that was queried. `known`: FootingKnown. `slows_for`: steepness to slow down
/// for, m per m; 0: none. `looked_at`: Gait::revision of the gait last checked for it. If that is the current one and
/// `level_speed_m_s` is not 0, the gait is slowed, and the `level_` fields are the walk requested on level ground. All
/// zero: level and not yet queried.
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

/// Returns all arrays that are indexed by FootholdOf.
template <class F>
std::array<F (*)[3], 5> by_foothold(Footing<F>& footing) {
  return {&footing.height_m, &footing.rise_x, &footing.rise_z, &footing.moved_x_m, &footing.moved_z_m};
}

/// Fractions of the swing's time at which a foot's early and late lift are greatest. Each rises until then and falls
/// afterwards as 10 u³ − 15 u⁴ + 6 u⁵.
namespace swing_lift {
inline constexpr float early = 0.35F, late = 0.70F;
}

/// Ground that is known: none; the previous step's, up to the stance foothold; all.
enum FootingKnown : unsigned { footing_unknown = 0, footing_before = 1, footing_all = 2 };

}  // namespace mobil::inline v0_3
