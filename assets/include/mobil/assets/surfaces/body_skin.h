#pragma once
// A person's skin: one closed surface whose triangles, parts and binding are the same for everybody, and whose places
// are a body's own.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/clothes.h>
#include <mobil/assets/surfaces/fat_places.h>
#include <mobil/assets/surfaces/leg_grid.h>
#include <mobil/assets/surfaces/skin_binding.h>
#include <mobil/assets/surfaces/trunk_fit.h>
#include <mobil/components/body.h>
#include <mobil/components/pose.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// How many triangles: some 90,000, 20,000, 5,000, 1200.
enum class SkinDetail : std::uint8_t { hero, near, far, distant };
inline constexpr std::size_t skin_details = 4;

/// The triangles that all men share, or all women, and how their corners hang on the skeleton.
struct SkinMesh {
  std::vector<std::uint32_t> triangle;  // three corners each, wound outwards; part by part
  std::array<std::uint32_t, skin_parts + 1>
      first_triangle{};          // of each SkinPart, in triangles; the last is their count
  std::vector<SkinFrame> frame;  // those between the same two segments one after the other
  std::vector<SkinVertex> vertex;
  std::vector<LegPlace> leg;        // of each vertex
  std::vector<FatPlace> fat;        // of each vertex
  std::vector<Vec3<double>> place;  // of `skin_body`, in the pose that is meshed
};
/// Whose skin is meshed.
constexpr BodyRequest skin_body(Sex sex) {
  return {.height_m = 1.75F, .mass_kg = 75, .sex = sex};
}
/// A body whose skin serves for those of about its build: of the same sex, as tall as skin_body, with a body mass index
/// that is `step` times `index_step` kg/m², within 13.5 to 64.5 as far as there are such bodies.
struct SkinBuild {
  int step;
  BodyRequest body;
};
SkinBuild skin_build(const BodyRequest& body, float index_step);
/// Of men and of women, whose hair has other borders. Made at its first use, in about two seconds, for all details;
/// safe from any thread.
const SkinMesh& skin_mesh(Sex sex, SkinDetail detail);

/// One body's skin in the anatomical position, m.
struct BodySkin {
  Sex sex{};
  SkinDetail detail{};
  std::vector<Vec3<float>> rest, normal;
  LegGrid leg;
  Pose<float> standing;  // the pose in which it is so
};

/// What the skin wears.
struct SkinDress {
  bool dressed = true;  // shirt, shorts, shoes and hair stand off the skin
};

/// The skin of a body: the shared surface is drawn onto the body's own form, whose trunk has the survey's girths at
/// hips, waist, chest and neck and the volume that weighs the body's mass at its density (Siri 1961, from its fat),
/// without the air in the lungs. Both may be 1.5 % off; what that leaves open the trunk has between hips and chest.
/// Errors: as make_body; limbs of their
/// own (BodyRequest::limbs).
Result<BodySkin> make_body_skin(const Body& body, SkinDetail detail, const SkinDress& dress = {});
/// The same; `fit`: from `fit_trunk` for this body or one like it, `body` from make_body.
BodySkin make_body_skin(const Body& body, const form::TrunkFit& fit, SkinDetail detail, const SkinDress& dress);
/// What meets the girths and the mass to 1.5 %; each number 0.7 to 1.4, where what lies beyond is not met.
form::TrunkFit fit_trunk(const Body& body);

/// Volume within a closed surface, m³.
double enclosed_volume(const std::vector<std::uint32_t>& triangle, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
