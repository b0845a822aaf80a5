#pragma once
// A small town: a street with kerbs, a square, a stair up to a terrace, a ramp down from it, houses and parapets. World
// frame in m with +Y up. The street runs along X, and the square is on its +Z side.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>
#include <mobil/systems/avoidance/obstacles.h>
#include <mobil/systems/render/scene.h>
#include <mobil/terrain.h>

namespace mobil {

/// Paths through the town by Recast and Detour: a mesh of the walkable area, made once from the town's triangles, and
/// the shortest paths on it.
class TownPaths {
 public:
  /// Makes the mesh. Errors: Recast or Detour fails.
  static Result<TownPaths> make();
  TownPaths(TownPaths&&) noexcept;
  TownPaths& operator=(TownPaths&&) noexcept;
  ~TownPaths();

  /// Sets `corners` to those of the shortest path, its end last. Without a path it is empty.
  void find(GroundPoint from, GroundPoint to, std::vector<GroundPoint>& corners) const;

 private:
  struct Mesh;
  explicit TownPaths(std::unique_ptr<Mesh> mesh);
  std::unique_ptr<Mesh> mesh_;
};

/// A block with vertical sides. Its top rises along X from `at_low_m` to `at_high_m` above the street, m.
struct TownBlock {
  enum class Use { walk, wall };
  float low_x_m, high_x_m, low_z_m, high_z_m;
  float at_low_m, at_high_m;
  Use use;
  Colour colour;
};

std::span<const TownBlock> town_blocks();

/// Returns the ground: the highest walkable block at this place, or the street.
TerrainHeight town_ground(float x_m, float z_m);

/// Returns the walls around all blocks that are not walkable.
std::vector<Wall> town_walls();

/// Returns true on and near the stairs, where people must walk slowly.
bool on_town_stairs(float x_m, float z_m);

/// Returns the destinations of people. The first ones are the stops of the tour, from across the street to the foot of
/// the ramp.
std::span<const GroundPoint> town_places();
inline constexpr std::size_t tour_stops = 6;  // after its start

/// Triangles of one colour, counter-clockwise from outside; each corner has its own vertices.
struct TownMesh {
  std::vector<Vec3<float>> position, normal;
  std::vector<std::uint32_t> triangle;
  Colour colour;
};
/// Returns the meshes of the street and of all blocks.
std::vector<TownMesh> town_meshes();

/// Returns the joints of the paving as pairs of end points.
std::vector<Vec3<float>> town_paving();

}  // namespace mobil
