#pragma once
// Preparation of a triangle list for a viewer's shading.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include "engine/eigen.h"

namespace mobil::inline v0_3 {

/// Returns a column for each place.
Eigen::Matrix3Xd columns_of(std::span<const Vec3<float>> position);

/// Returns area-weighted unit normals of vertices, a column each; +Y if no triangle with area has the vertex.
Eigen::Matrix3Xd vertex_normals(const Eigen::Matrix3Xd& position, const std::vector<std::uint32_t>& triangle);

/// Returns the triangles with an area above a square micrometre, in their order. Position in m, three indices each.
std::vector<std::uint32_t> triangles_with_area(const Eigen::Matrix3Xd& position,
                                               const std::vector<std::uint32_t>& triangle);

}  // namespace mobil::inline v0_3
