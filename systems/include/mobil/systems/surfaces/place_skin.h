#pragma once
// Places a body's skin for the present pose of the skeleton.

#include <array>
#include <span>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/components/fat.h>
#include <mobil/components/pose.h>
#include <mobil/systems/surfaces/cover_muscles.h>
#include <mobil/systems/surfaces/skin_frames.h>
#include <mobil/systems/surfaces/skin_table.h>
#include <mobil/systems/surfaces/write_vertices.h>

namespace mobil::inline v0_3 {

/// The legs' lines in the anatomical position, m, by Side.
struct LegLines {
  std::array<Vec3<float>, 2> hip;
  std::array<float, 2> knee_y, ankle_y;
};

/// Displacement of the fat of each region from its rest position, m, world frame (systems/gait/fat_motion.h).
using FatBeside = std::array<Vec3<float>, fat_regions>;

/// Writes positions and unit normals of all vertices into the caller's buffer. Normals at rest are rotated, and tilted
/// by the slope of the cover. `cover` is the lift over muscles and `fat` the displacement of fat, or null.
/// `out.tangent` must be null. The bits are the same on every instruction set with fused multiply-add.
void place_skin(const SkinMesh& mesh, const BodySkin& skin, std::span<const FrameMap> maps, const SkinCover* cover,
                const FatBeside* fat, const VertexTarget& out);

/// Computes the frames, the lift over muscles, and the vertices of a skin. `muscles` are vertices by Side (world, m).
/// If empty, `table` gives the lift, if any. `maps` is scratch memory for the mesh's frames.
void pose_skin(const BodySkin& skin, const Pose<float>& pose, float lengths, const Vec3<float>& origin_m,
               const std::array<std::span<const Vec3<float>>, 2>& muscles, const SkinTable* table, const FatBeside* fat,
               std::span<FrameMap> maps, const VertexTarget& out);

}  // namespace mobil::inline v0_3
