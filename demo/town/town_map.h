#pragma once
// A small town: a street with kerbs, a square, a stair up to a terrace, a ramp down from it, houses and parapets. World
// frame: m, +Y up; the street runs along X, the square lies ahead of it.

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

/// Ways through the town by Recast and Detour: a mesh of where people can walk, made once of the town's triangles, and
/// the shortest ways on it.
class TownPaths {
 public:
  /// Errors: Recast fails.
  static Result<TownPaths> make();
  TownPaths(TownPaths&&) noexcept;
  TownPaths& operator=(TownPaths&&) noexcept;
  ~TownPaths();

  /// Corners of the shortest way, its end last; empty where there is none.
  void find(GroundPoint from, GroundPoint to, std::vector<GroundPoint>& corners) const;

 private:
  struct Mesh;
  explicit TownPaths(std::unique_ptr<Mesh> mesh);
  std::unique_ptr<Mesh> mesh_;
};

/// A block with upright sides whose top rises from `at_low` to `at_high` along X, m over the street.
struct TownBlock {
  enum class Use { walk, wall };
  float low_x_m, high_x_m, low_z_m, high_z_m;
  float at_low_m, at_high_m;
  Use use;
  Colour colour;
};

std::span<const TownBlock> town_blocks();

/// The ground, of the blocks that people walk on the highest; the street's elsewhere.
TerrainHeight town_ground(float x_m, float z_m);

/// Round each block that nobody walks on.
std::vector<Wall> town_walls();

/// Where steps have to be short and slow.
bool on_town_stairs(float x_m, float z_m);

/// Places that people go to; the first few are the way that a visitor is shown, from across the street to the foot of
/// the ramp.
std::span<const GroundPoint> town_places();
inline constexpr std::size_t tour_stops = 6;  // after where it begins

/// Triangles of one colour, counter-clockwise from outside; each corner has its own vertices.
struct TownMesh {
  std::vector<Vec3<float>> position, normal;
  std::vector<std::uint32_t> triangle;
  Colour colour;
};
/// The street and all blocks.
std::vector<TownMesh> town_meshes();

/// Joints of the paving, pairs of ends.
std::vector<Vec3<float>> town_paving();

}  // namespace mobil
