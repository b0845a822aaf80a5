#pragma once
// Obstacles for walkers: walls and moving discs.

namespace mobil::inline v0_3 {

/// A point on the ground, m.
struct GroundPoint {
  float x_m, z_m;
};
/// A straight wall between two points.
struct Wall {
  GroundPoint from, to;
};
/// A player, a car or a pillar. Its velocity is taken to be constant as far as walkers look ahead.
struct Disc {
  GroundPoint at;
  float radius_m;
  float x_m_s = 0, z_m_s = 0;
};

}  // namespace mobil::inline v0_3
