#pragma once
// Custom skin meshes, such as scans or atlases. So far they are legs, which replace those of a body's skin and move
// with it.

#include <cstdint>
#include <span>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/lanes.h>
#include <mobil/components/surface.h>

namespace mobil::inline v0_3 {

/// A vertex relative to a triangle of the body's skin. `corner` and `weight` (sum 1) give the point nearest to it.
/// `beside_m` is its offset from there, m, and `normal` its normal: along the triangle's first edge, across it in the
/// skin, and outwards.
struct SkinFollower {
  std::uint32_t corner[3];
  float weight[3];
  Vec3<float> beside_m, normal;
};

/// A bound mesh. `triangle` has its corners in `vertex`, wound outwards. `left` has the triangles of the body's skin
/// that stay, part by part as in SkinMesh.
struct CustomSkin {
  std::vector<std::uint32_t> triangle;
  std::vector<SkinFollower> vertex;
  std::vector<std::uint32_t> left;
  std::array<std::uint32_t, skin_parts + 1> first_left{};
};

/// Binds meshes of right legs, the body standing at x = z = 0 (m), and their mirror images. A flat cap at their top is
/// left out; over the last 6 cm below it they approach the body's skin. `position` and `normal` are of the body's skin
/// in that stance, over muscles at rest (pose_skin). Vertices farther than 8 cm from it are moved to that distance.
/// Meshes without triangles are skipped. `shorts_stay` shows the body's shorts; skin under them is left out or kept
/// below them.
CustomSkin bind_custom_skin(const BodySkin& skin, std::span<const Vec3<float>> position,
                            std::span<const Vec3<float>> normal, std::span<const SurfaceMesh> legs,
                            bool shorts_stay = false);

}  // namespace mobil::inline v0_3
