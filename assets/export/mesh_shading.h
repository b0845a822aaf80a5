#pragma once
// What a triangle list needs before a viewer can shade it.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// A column for each place.
Eigen::Matrix3Xd columns_of(std::span<const Vec3<float>> position);

/// Area-weighted vertex normals of unit length, a column per vertex; +Y where no triangle with area touches a vertex.
Eigen::Matrix3Xd vertex_normals(const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle);

/// The triangles whose area exceeds a square micrometre, in their order. Position in m, three indices a triangle.
std::vector<std::uint32_t> triangles_with_area(const Eigen::Matrix3Xd& position,
                                               const std::vector<std::uint32_t>& triangle);

}  // namespace mobil::inline v0_3
