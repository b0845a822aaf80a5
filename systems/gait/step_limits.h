#pragma once
// What one step may change of a walk (systems/gait/README.md, "Turning"): what one step cannot do, several do. Speeds
// are of a leg of 0.90 m, in proportion to the root of the leg.

namespace mobil::inline v0_3::step_limits {

inline constexpr float leg_m = 0.90F;
/// How far speed may change from step to step, and what a walk starts with and stops from, m/s.
inline constexpr float max_faster = 0.30F, max_slower = 0.60F, first_speed = 0.60F, last_speed = 1.35F;
/// How long a first and a last step take, of the pace that they lead to or come from.
inline constexpr float first_step = 0.9F, last_step = 1.3F;
/// A step on the spot, of somebody who stands and turns, and standing before the next decision, s.
inline constexpr float spot_step_s = 0.4F, stand_s = 0.25F;
/// A step aside, of somebody who stands, is two: one foot goes there and the other one follows. Each takes so long, s
/// and s per m: in less the ground could not push the body there.
inline constexpr float displacing_s = 0.3F, displacing_s_per_m = 0.8F;
/// The longest way of a step aside, and ahead or back, m for a leg of 0.85 m in proportion to the leg.
inline constexpr float aside_m = 0.25F, ahead_m = 0.20F, aside_leg_m = 0.85F;
/// A turn a step, rad, and its acceleration sideways, m/s².
inline constexpr float max_turn = 30.0F * 3.14159265F / 180.0F, max_sideways = 1.1F;

}  // namespace mobil::inline v0_3::step_limits
