#pragma once
// Moves a custom skin mesh with the skin of the body.

#include <span>

#include <mobil/assets/surfaces/custom_skin.h>

namespace mobil::inline v0_3 {

/// Computes positions (m) and unit normals of a custom skin, both as long as own.vertex, at 10 ns a vertex.
/// `skin_position` and `skin_normal` are of the body's skin (place_skin) at the detail that the mesh was bound to.
void follow_skin(const CustomSkin& own, std::span<const Vec3<float>> skin_position,
                 std::span<const Vec3<float>> skin_normal, std::span<Vec3<float>> position,
                 std::span<Vec3<float>> normal);

}  // namespace mobil::inline v0_3
