#pragma once
// What `mobil walk` walks on: --ground, its heights and its picture.

#include <cstdint>
#include <string>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include <mobil/terrain.h>

namespace mobil {

enum class GroundKind { level, slope, cross, hills, kerb, stairs };

/// A walk goes from (0, 0) toward +Z. `rise`: of slopes m per m, else m; below 0: down. `edge_m`: where the kerb or the
/// first stair begins.
struct WalkGround {
  GroundKind kind = GroundKind::level;
  float rise = 0, tread_m = 0, edge_m = 0;

  TerrainHeight at(float x_m, float z_m) const;
};

/// For the end of --help.
extern const char* const walk_ground_help;

/// Reads level, slope:10%, cross:-5%, hills:20cm, kerb:15cm or stairs:16cm/30cm. Errors name the option, the range and
/// the mend.
Result<WalkGround> read_walk_ground(const std::string& text);

/// Stairs and kerbs where a walker of that height and step length comes to them as people do: going up with the whole
/// foot on the stair, going down with the toes over its edge.
void set_edges(WalkGround& ground, float height_m, float step_length_m);

/// A strip under the walk, 3 m wide, and lines across it.
struct GroundPicture {
  std::vector<Vec3<float>> position, normal, line;
  std::vector<std::uint32_t> triangle;
};
GroundPicture picture_of(const WalkGround& ground, float length_m);

}  // namespace mobil
