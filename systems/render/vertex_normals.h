#pragma once
// Smooth normals for a surface whose vertices move.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Unit normal of every vertex: the mean of its triangles' normals weighted by their areas; up (+Y) where a vertex has
/// no triangle or they cancel. Indices must be below position.size(). `normal` is resized and keeps its memory.
void vertex_normals(std::span<const Vec3<float>> position, std::span<const std::uint32_t> triangle,
                    std::vector<Vec3<float>>& normal);

}  // namespace mobil::inline v0_3
