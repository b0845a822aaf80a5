#pragma once
// State of a walker who avoids others: the desired velocity and the rotation of the shoulders in narrow gaps. It is
// stored on the person's row.

#include <cstdint>

namespace mobil::inline v0_3 {

/// Desired velocity (systems/avoidance): speed, 0 to stand, and heading. `usual`: step length relative to the usual one
/// at that speed. `radius_m`: half the breadth that other people keep clear; `shoulders_m`: that of the shoulders with
/// the arms. `waits_s`: time that the walker has stood against its desired velocity. `turn_rad`, `turn_rad_s`,
/// `turn_to_rad`: angle of the shoulders from the pelvis, positive to the left, its rate and its target.
template <class F>
struct AvoidanceState {
  static constexpr std::uint64_t stable_id = 0x1de08feca6e47ca7;
  F speed_m_s, heading_rad;
  F usual, radius_m, shoulders_m;
  F waits_s;
  F turn_rad, turn_rad_s, turn_to_rad;
};

}  // namespace mobil::inline v0_3
