#pragma once
// What is in walkers' way and is no walker.

namespace mobil::inline v0_3 {

/// A place on the ground, m.
struct GroundPoint {
  float x_m, z_m;
};
/// What nobody walks through: a straight wall between two points.
struct Wall {
  GroundPoint from, to;
};
/// A player, a car, a pillar. It goes on at that velocity as far as anybody looks.
struct Disc {
  GroundPoint at;
  float radius_m;
  float x_m_s = 0, z_m_s = 0;
};

}  // namespace mobil::inline v0_3
