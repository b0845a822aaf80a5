#include "assets/export/mesh_shading.h"

#include "engine/eigen.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double min_area_m2 = 1e-12;

Eigen::Vector3d twice_area(const Eigen::Matrix3Xd& position, const std::uint32_t* corner) {
  const Eigen::Vector3d a = position.col(corner[0]);
  return (position.col(corner[1]) - a).cross(position.col(corner[2]) - a);
}

}  // namespace

Eigen::Matrix3Xd columns_of(std::span<const Vec3<float>> position) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(position.size()));
  for (std::size_t v = 0; v < position.size(); ++v) {
    columns.col(static_cast<Eigen::Index>(v)) << static_cast<double>(position[v].x), static_cast<double>(position[v].y),
        static_cast<double>(position[v].z);
  }
  return columns;
}

Eigen::Matrix3Xd vertex_normals(const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle) {
  Eigen::Matrix3Xd normal = Eigen::Matrix3Xd::Zero(3, position.cols());
  for (std::size_t t = 0; t + 2 < triangle.size(); t += 3) {
    const Eigen::Vector3d weighted = twice_area(position, &triangle[t]);
    for (std::size_t corner = 0; corner < 3; ++corner) normal.col(triangle[t + corner]) += weighted;
  }
  for (auto column : normal.colwise()) {
    const double length = column.norm();
    if (length > 1e-30) {
      column /= length;
    } else {
      column = Eigen::Vector3d::UnitY();
    }
  }
  return normal;
}

std::vector<std::uint32_t> triangles_with_area(const Eigen::Matrix3Xd& position,
                                               const std::vector<std::uint32_t>& triangle) {
  std::vector<std::uint32_t> kept;
  kept.reserve(triangle.size());
  for (std::size_t t = 0; t + 2 < triangle.size(); t += 3) {
    if (twice_area(position, &triangle[t]).norm() <= 2 * min_area_m2) continue;
    kept.insert(kept.end(), {triangle[t], triangle[t + 1], triangle[t + 2]});
  }
  return kept;
}

}  // namespace mobil::inline v0_3
