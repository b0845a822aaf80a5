#pragma once
// Where a walker who avoids others wants to go: state like any other, on the person's row.

namespace mobil {

/// What is asked for (systems/avoidance): a speed, 0 to stand, and a heading; how long the steps are to be, of usual
/// ones; half the breadth that is kept clear. `waits_s`: how long the walker has stood though it wants to walk.
template <class F>
struct Course {
  F speed_m_s, heading_rad;
  F usual, radius_m;
  F waits_s;
};

}  // namespace mobil
