#pragma once
// What of a body's surface is skin and what is covered: regions with clean borders, for colours of their own.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// `legs`: bare skin below the shorts.
enum class SkinPart : std::uint8_t { skin, legs, lips, hair, shirt, shorts, shoes };
inline constexpr std::size_t skin_parts = 7;

/// Every triangle's part. Triangles that a border crosses are divided along it; their new corners lie on the edges.
/// `hems`: a second cut close beside that of cloth, so that its edge is a clean step.
std::vector<SkinPart> cut_clothes(const form::BodyForm& form, SurfaceMesh& mesh, bool hems);

/// How far cloth and hair stand off the skin, m; 0 on bare skin. `place`: in the pose that is meshed.
std::vector<double> cloth_thickness(const form::BodyForm& form, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
