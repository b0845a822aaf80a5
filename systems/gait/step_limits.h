#pragma once
// Limits on the change of a walk within one step (systems/gait/README.md, "Turning"). Larger changes take several
// steps. Speeds are for a leg of 0.90 m and scale with the square root of the leg.

namespace mobil::inline v0_3::step_limits {

inline constexpr float leg_m = 0.90F;
/// Maximum change of speed per step, maximum speed of a first step, and maximum speed from which a walk stops, m/s.
inline constexpr float max_faster = 0.30F, max_slower = 0.60F, first_speed = 0.60F, last_speed = 1.35F;
/// Duration of a first and of a last step, relative to the pace that they lead to or come from.
inline constexpr float first_step = 0.9F, last_step = 1.3F;
/// Duration of a step on the spot by a standing person who turns, and of standing until the next decision, s.
inline constexpr float spot_step_s = 0.4F, stand_s = 0.25F;
/// A standing person steps aside in two steps: one foot moves there and the other follows. Each takes this long, s and
/// s per m. In less time the ground could not push the body there.
inline constexpr float displacing_s = 0.3F, displacing_s_per_m = 0.8F;
/// Maximum length of a step aside, and ahead or back, m for a leg of 0.85 m, in proportion to the leg.
inline constexpr float aside_m = 0.25F, ahead_m = 0.20F, aside_leg_m = 0.85F;
/// Maximum turn per step, rad, and its sideways acceleration, m/s².
inline constexpr float max_turn = 30.0F * 3.14159265F / 180.0F, max_sideways = 1.1F;

}  // namespace mobil::inline v0_3::step_limits
