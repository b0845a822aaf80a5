#pragma once
// A skin mesh of somebody's own, as from a scan or an atlas: legs so far, in place of those of their body's skin, with
// which it moves.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/lanes.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// Where a vertex is beside a triangle of the body's skin: the corners and their weights (sum 1) of the point nearest
/// to it, how far off it is, m, and its normal, both along the triangle's first edge, across it in the skin, and
/// outwards.
struct SkinFollower {
  std::uint32_t corner[3];
  float weight[3];
  Vec3<float> beside_m, normal;
};

/// `triangle`: corners among `vertex`, wound outwards. `left`: of the body's skin, what is not in its place, part by
/// part as in SkinMesh.
struct CustomSkin {
  std::vector<std::uint32_t> triangle;
  std::vector<SkinFollower> vertex;
  std::vector<std::uint32_t> left;
  std::array<std::uint32_t, skin_parts + 1> first_left{};
};

/// Binds meshes of right legs, the body standing at x = z = 0 (m), and their mirror images. They may be closed flat at
/// their top, which is left out; over the last 6 cm below it they come to the body's skin. `position`, `normal`: of the
/// body's skin where it stands, over muscles as they are at rest (pose_skin). Vertices that are more than 8 cm beside
/// it are brought as near as that. Meshes without triangles make nothing. `shorts_stay`: the body's
/// shorts are shown, and what is under them is left out or keeps under them.
CustomSkin bind_custom_skin(const BodySkin& skin, std::span<const Vec3<float>> position,
                            std::span<const Vec3<float>> normal, std::span<const SurfaceMesh> legs,
                            bool shorts_stay = false);

}  // namespace mobil::inline v0_3
