#pragma once
// A skin mesh of somebody's own where the skin of their body is now.

#include <span>

#include <mobil/assets/surfaces/custom_skin.h>

namespace mobil::inline v0_3 {

/// Positions and unit normals of all its vertices. `skin_position`, `skin_normal`: of the body's skin (place_skin), of
/// the detail that the mesh was bound to. `position`, `normal`: as many as own.vertex. Some 10 ns a vertex.
void follow_skin(const CustomSkin& own, std::span<const Vec3<float>> skin_position,
                 std::span<const Vec3<float>> skin_normal, std::span<Vec3<float>> position,
                 std::span<Vec3<float>> normal);

}  // namespace mobil::inline v0_3
