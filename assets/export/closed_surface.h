#pragma once
// Positions of points relative to a closed surface: inside or outside, and the nearest place on it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A nearest place on a surface: the place, the outward normal of its triangle, and the distance to it, m.
struct SurfacePlace {
  Eigen::Vector3d at = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitY();
  double distance_m = 0;
  std::size_t triangle = 0;  // its number
};

/// Triangles in a tree of boxes. Columns of `position` are vertices, m; triangles are wound outwards. The surface can
/// overlap itself.
class ClosedSurface {
 public:
  ClosedSurface(const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle);

  /// Returns true if rays in three directions all leave the surface as often as they enter it.
  bool is_outside(const Eigen::Vector3d& point) const;
  SurfacePlace nearest(const Eigen::Vector3d& point) const;

 private:
  struct Box {
    Eigen::Vector3d low, high;
    std::size_t first = 0, count = 0, left = 0, right = 0;  // children, both 0 for a leaf
  };
  std::size_t build(std::size_t first, std::size_t end);
  int crossings(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, std::size_t box) const;
  void approach(const Eigen::Vector3d& point, std::size_t box, double& squared, SurfacePlace& best) const;

  struct Triangle {
    std::array<Eigen::Vector3d, 3> corner;
    std::size_t number = 0;
  };
  std::vector<Triangle> triangle_;  // in the order of boxes
  std::vector<Box> box_;
};

}  // namespace mobil::inline v0_3
