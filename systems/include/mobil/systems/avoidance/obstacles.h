#pragma once
// Obstacles for walkers: walls and moving discs.

#include <limits>

namespace mobil::inline v0_3 {

/// A point on the ground, m.
struct GroundPoint {
  float x_m, z_m;
};
/// Bottom and top of an obstacle, m. Walkers whose ground is at or above the top, or more than 2 m below the bottom, do
/// not see it. By default it has all heights.
struct HeightRange {
  float low_m = -std::numeric_limits<float>::infinity(), high_m = std::numeric_limits<float>::infinity();
};
/// A straight wall between two points.
struct Wall {
  GroundPoint from, to;
  HeightRange height{};
};
/// A player, a car or a pillar. Its velocity is taken to be constant as far as walkers look ahead.
struct Disc {
  GroundPoint at;
  float radius_m;
  float x_m_s = 0, z_m_s = 0;
  HeightRange height{};
};

}  // namespace mobil::inline v0_3
