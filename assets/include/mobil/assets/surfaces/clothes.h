#pragma once
// Bare and covered regions of a body's surface, with clean borders, for separate colours.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Parts of the surface. `legs` is the bare skin below the shorts.
enum class SkinPart : std::uint8_t { skin, legs, lips, hair, shirt, shorts, shoes };
inline constexpr std::size_t skin_parts = 7;

/// Returns the part of each triangle. Triangles that a border crosses are divided along it, with new corners on their
/// edges. `hems` adds a second cut close to that of cloth, so that its edge is a clean step.
std::vector<SkinPart> cut_clothes(const form::BodyForm& form, SurfaceMesh& mesh, bool hems);

/// Returns the offset of cloth and hair from the skin, m; 0 on bare skin. `place` is in the meshing pose.
std::vector<double> cloth_thickness(const form::BodyForm& form, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
