#pragma once
// A body's skin where its skeleton is now.

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

/// Where the legs' lines are in the anatomical position, m; by Side.
struct LegLines {
  std::array<Vec3<float>, 2> hip;
  std::array<float, 2> knee_y, ankle_y;
};

/// By how much the fat of each region is beside its place, m, world frame (systems/gait/fat_motion.h).
using FatBeside = std::array<Vec3<float>, fat_regions>;

/// Positions and unit normals of all vertices, into the caller's buffer. Normals are those at rest, turned, and
/// tilted as the cover slopes. `cover`: what muscles lift the legs by; `fat`: what wobbles; null: nothing. Tangents are
/// not written (`out.tangent` must be null). The same bits on every instruction set with fused multiply-add.
void place_skin(const SkinMesh& mesh, const BodySkin& skin, std::span<const FrameMap> maps, const SkinCover* cover,
                const FatBeside* fat, const VertexTarget& out);

/// All of it: frames, what muscles lift (world, m, by Side; none: as `table` says, and without one the leg is as it is
/// without), vertices. `maps`: of the mesh's frames, to work in.
void pose_skin(const BodySkin& skin, const Pose<float>& pose, float lengths, const Vec3<float>& origin_m,
               const std::array<std::span<const Vec3<float>>, 2>& muscles, const SkinTable* table, const FatBeside* fat,
               std::span<FrameMap> maps, const VertexTarget& out);

}  // namespace mobil::inline v0_3
