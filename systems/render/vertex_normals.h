#pragma once
// Smooth normals of a surface with moving vertices.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Computes the unit normal of every vertex: the area-weighted mean of the normals of its triangles, or +Y for a vertex
/// without triangles or with a zero sum. Indices must be below position.size(). `normal` is resized.
void vertex_normals(std::span<const Vec3<float>> position, std::span<const std::uint32_t> triangle,
                    std::vector<Vec3<float>>& normal);

}  // namespace mobil::inline v0_3
