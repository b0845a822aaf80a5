#pragma once
// The ground of `mobil walk`: option --ground, heights and picture.

#include <cstdint>
#include <string>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include <mobil/terrain.h>

namespace mobil {

enum class GroundKind { level, slope, cross, hills, kerb, stairs };

/// The ground of a walk from (0, 0) toward +Z. `rise` is in m per m for slopes, else in m; negative values descend.
/// `edge_m` is the place of the kerb or the first stair.
struct WalkGround {
  GroundKind kind = GroundKind::level;
  float rise = 0, tread_m = 0, edge_m = 0;

  TerrainHeight at(float x_m, float z_m) const;
};

/// Part of --help about the ground.
extern const char* const walk_ground_help;

/// Reads `level`, `slope:10%`, `cross:-5%`, `hills:20cm`, `kerb:15cm` or `stairs:16cm/30cm`. Errors name the option,
/// the range and the remedy.
Result<WalkGround> read_walk_ground(const std::string& text);

/// Places stairs or kerb for a walker of that height and step length, at the footholds of people. Going up, the whole
/// foot is on the stair; going down, the toes are over its edge.
void set_edges(WalkGround& ground, float height_m, float step_length_m);

/// A strip under the walk, 3 m wide, and lines across it.
struct GroundPicture {
  std::vector<Vec3<float>> position, normal, line;
  std::vector<std::uint32_t> triangle;
};
GroundPicture picture_of(const WalkGround& ground, float length_m);

}  // namespace mobil
