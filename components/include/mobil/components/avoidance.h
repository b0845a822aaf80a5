#pragma once
// Where a walker who avoids others wants to go, and how they make themselves narrow: state like any other, on the
// person's row.

#include <cstdint>

namespace mobil::inline v0_3 {

/// What is asked for (systems/avoidance): a speed, 0 to stand, and a heading; how long the steps are to be, of usual
/// ones. Half the breadth that other people keep clear, and half of the shoulders' breadth with the arms. `waits_s`:
/// how long the walker has stood though it wants to walk. How far the shoulders are turned against the way that the
/// pelvis faces, positive to the left, how fast, and how far they are to be.
template <class F>
struct AvoidanceState {
  static constexpr std::uint64_t stable_id = 0x1de08feca6e47ca7;
  F speed_m_s, heading_rad;
  F usual, radius_m, shoulders_m;
  F waits_s;
  F turn_rad, turn_rad_s, turn_to_rad;
};

}  // namespace mobil::inline v0_3
