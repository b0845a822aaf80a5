#pragma once
// A person's skin: one closed surface. People of one sex share its triangles, parts and binding; the positions are a
// body's own.

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

/// Levels of detail, with about 90,000, 20,000, 5,000 and 1200 triangles.
enum class SkinDetail : std::uint8_t { hero, near, far, distant };
inline constexpr std::size_t skin_details = 4;

/// Triangles shared by all men, or by all women, and the binding of their corners to the skeleton.
struct SkinMesh {
  std::vector<std::uint32_t> triangle;  // three corners each, wound outwards; part by part
  std::array<std::uint32_t, skin_parts + 1>
      first_triangle{};          // of each SkinPart, in triangles; the last is their count
  std::vector<SkinFrame> frame;  // those between the same two segments are adjacent
  std::vector<SkinVertex> vertex;
  std::vector<LegPlace> leg;        // of each vertex
  std::vector<FatPlace> fat;        // of each vertex
  std::vector<Vec3<double>> place;  // of `skin_body`, in the meshing pose
};
/// Returns the body whose skin is meshed.
constexpr BodyRequest skin_body(Sex sex) {
  return {.height_m = 1.75F, .mass_kg = 75, .sex = sex};
}
/// A body whose skin serves bodies of about its build. It has their sex and a body mass index of `step` times
/// `index_step` kg/m², within 13.5 to 64.5 and the range of its age. Ages are in steps of 2 years up to 16, then 25 and
/// steps of 15 years up to 85. Adults have the height of skin_body, children their age's median.
struct SkinBuild {
  int age_y, step;
  BodyRequest body;
};
SkinBuild skin_build(const BodyRequest& body, float index_step);
/// Returns the body of a build.
BodyRequest build_body(Sex sex, int age_y, float body_mass_index);
/// Returns the mesh of men or of women, whose hairlines differ. All levels of detail are made at first use, in about
/// two seconds; safe from any thread.
const SkinMesh& skin_mesh(Sex sex, SkinDetail detail);
/// Gives a mesh, so that `skin_mesh` does not make it. It must be the one that it would make. Has no effect once the
/// mesh exists.
void give_skin_mesh(Sex sex, SkinDetail detail, SkinMesh mesh);

/// One body's skin in the anatomical position, m.
struct BodySkin {
  Sex sex{};
  SkinDetail detail{};
  std::vector<Vec3<float>> rest, normal;
  LegGrid leg;
  Pose<float> standing;  // pose of `rest`
};

/// Clothing of a skin.
struct SkinDress {
  bool dressed = true;  // shirt, shorts, shoes and hair stand off the skin
};

/// Makes the skin of a body by drawing the shared surface onto the body's own form. The trunk has the survey's girths
/// at hips, waist, chest and neck. The volume without the air in the lungs has the body's mass at its density (Siri
/// 1961, from its fat). Both can be 1.5 % off; the trunk between hips and chest takes up the rest. Fails as make_body,
/// or on custom limb lengths (BodyRequest::limbs).
Result<BodySkin> make_body_skin(const Body& body, SkinDetail detail, const SkinDress& dress = {});
/// Takes `fit` from `fit_trunk` for this body or a similar one, and `body` from make_body.
BodySkin make_body_skin(const Body& body, const form::TrunkFit& fit, SkinDetail detail, const SkinDress& dress);
/// Returns factors that meet girths and mass to 1.5 %. They are limited to 0.7–1.4 (thighs 0.9–1), even if that misses
/// them.
form::TrunkFit fit_trunk(const Body& body);

/// Returns the volume within a closed surface, m³.
double enclosed_volume(const std::vector<std::uint32_t>& triangle, const std::vector<Vec3<double>>& place);

}  // namespace mobil::inline v0_3
