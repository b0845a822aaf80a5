#pragma once
// Walkers on uneven ground: slopes, kerbs, stairs, fields. The host returns the height of the ground. Feet then stand
// on it at its tilt, and clear obstacles between two footholds.
//
//   Simulation simulation;
//   simulation.terrain().set_heights([&](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
//     for (std::size_t i = 0; i < at.size(); ++i) out[i].height_m = my_world.height(at[i].x_m, at[i].z_m);
//   });
//   simulation.terrain().manage({&person, 1});
//   simulation.advance(frame_seconds);
//
// Each step queries the ground once: under the next foothold, slightly behind and ahead of it because feet avoid edges,
// and along the path of the foot. The heights are state on the person's row (mobil/components/footing.h), so a restored
// world uses the same ones. Unmanaged people walk on the plane y = 0 at no extra cost.

#include <cstddef>
#include <functional>
#include <span>

#include <mobil/components/footing.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>

namespace mobil::inline v0_3 {

/// A query: a position on the ground, m, and the person who will step there.
struct TerrainQuery {
  float x_m, z_m;
  Entity person;
};

/// The ground at a queried position: height, m, and slopes toward +X and +Z, m per m. From a normal n the slopes are
/// −n.x/n.y and −n.z/n.y.
struct TerrainHeight {
  float height_m = 0, rise_x = 0, rise_z = 0;
};

/// Resolves all queries of a tick at once, on the thread that calls `tick`. `out` is as long as `at` and initially
/// zero. Heights must be within ±100 km, and slopes are clamped to ±1. An unusable height is replaced by the plane of
/// another query under the same sole, or by level ground at the height of the last foothold. The function must not
/// change the simulation. Runs are reproducible if it always returns the same ground.
using TerrainHeights = std::function<void(std::span<const TerrainQuery> at, std::span<TerrainHeight> out)>;

/// Counts of all ticks of the last `advance` or `tick`: managed people (of the last tick), queried steps, queried
/// positions, and heights that were not finite or out of range.
struct TerrainReport {
  std::size_t people = 0, asked = 0, places = 0, unusable = 0;
};

/// With `slows_down` walkers reduce their speed on slopes and stairs (assets/gait/slope_pace.h), one step after their
/// feet get there, and resume the requested gait on level ground. Their Gait is then the slower one, and a gait
/// requested meanwhile is for level ground. Avoidance scales its desired velocities.
struct TerrainOptions {
  bool slows_down = false;
};

struct TerrainWork;  // systems/terrain/terrain.cpp

/// Interface to the ground of a simulation (Simulation::terrain). Each tick queries the ground of people with a new
/// next foothold, and of people whose ground is unknown after they were placed or woke. It allocates only if more
/// people are queried at once than before. A call that fails changes nothing.
class Terrain {
 public:
  explicit Terrain(const Frame& frame) : frame_(frame) {}

  /// Sets the function that resolves queries from now on. Without one, or with an empty one, ticks query nothing; use
  /// `query` and `resolve`. It is not state: a simulation that restores a snapshot keeps its own.
  void set_heights(TerrainHeights heights);
  /// Sets the options from the next resolved queries on. If `slows_down` is switched off, slowed walkers resume the
  /// requested gait within a step.
  void set_options(const TerrainOptions& options);

  /// Puts walkers on that ground. Their pose follows it from the next tick on. Sleepers and compact people become full.
  /// All or none. Errors: a stale handle, a posed person (Status::missing).
  Result<void> manage(std::span<const Entity> people);
  /// Returns walkers to the plane y = 0 from the next tick on. All or none. Errors: a stale handle, a person who is not
  /// managed (Status::missing).
  Result<void> release(std::span<const Entity> people);

  /// Returns the queries of the next tick, for a host whose ground is not a function: in another language, or found by
  /// its own jobs. Changes nothing. Valid until the next `query`.
  std::span<const TerrainQuery> query();
  /// Sets the ground at the positions of the last `query`, in their order, once, and before the next tick. Until then
  /// the last height holds, and a foot whose foothold is resolved later jumps. People who were removed or took a step
  /// since are skipped and queried again. Returns the number of unusable heights. Errors: a number of heights other
  /// than that of the queries (Status::not_valid).
  Result<std::size_t> resolve(std::span<const TerrainHeight> heights);

  /// Returns the counts of all ticks of the last `advance` or `tick`.
  const TerrainReport& report() const;

 private:
  TerrainWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
