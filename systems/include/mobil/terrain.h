#pragma once
// Walkers on ground that is not level: slopes, kerbs, stairs, fields. A host answers how high the ground is; feet then
// stand on it, tilted as it is, and pass over what lies between two footholds.
//
//   Simulation simulation;
//   Terrain terrain(simulation, [&](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
//     for (std::size_t i = 0; i < at.size(); ++i) out[i].height_m = my_world.height(at[i].x_m, at[i].z_m);
//   });
//   terrain.manage({&human, 1});
//   terrain.update();                                        // before each tick
//   simulation.tick();
//
// The ground is asked for once a step and person: under the foothold to come and a little behind and ahead of it, for
// feet keep clear of edges, and along the way of the foot to it. The
// answers are state on the person's row (mobil/components/footing.h), so a restored world uses the same ones. Who is
// not managed walks on the plane y = 0 and costs what they did.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include <mobil/components/footing.h>
#include <mobil/engine/error.h>
#include <mobil/simulation.h>

namespace mobil::inline v0_3 {

/// Where the ground is asked for, m, and by whom.
struct TerrainQuery {
  float x_m, z_m;
  Entity human;
};

/// The ground there: its height, m; how much it rises toward +X and toward +Z, m per m. Of a normal n: −n.x/n.y and
/// −n.z/n.y.
struct TerrainHeight {
  float height_m = 0, rise_x = 0, rise_z = 0;
};

/// Answers all queries of an update at once, on the thread that calls `update`; `out` is as long and all zero. Heights
/// within ±100 km; rises within ±1, steeper ones are taken as that. Instead of an
/// answer that is not a number the plane of another under the same sole is taken, or level ground at the height of the
/// last foothold.
/// Must not change the simulation. The same places must get the same answers where a run is to be repeated.
using TerrainHeights = std::function<void(std::span<const TerrainQuery> at, std::span<TerrainHeight> out)>;

/// What an update did: people looked at, those whose ground was asked for, how many places; and how many answers were
/// not numbers or out of range.
struct TerrainReport {
  std::size_t people = 0, asked = 0, places = 0, unusable = 0;
};

/// `slows_down`: walkers slow down on slopes and stairs (assets/gait/slope_pace.h), one step after their feet come
/// there, and go on as asked where it is level. Their Gait then is the slower one; a gait asked for meanwhile is one
/// for level ground. Avoidance slows what it wants.
struct TerrainOptions {
  bool slows_down = false;
};

/// Puts those it manages on the host's ground, before each tick.
class Terrain {
 public:
  /// Works on `simulation`, which must outlive it and stay where it is.
  /// Without `heights`, `update` does nothing: use `ask` and `answer`.
  explicit Terrain(Simulation& simulation, TerrainHeights heights = {}, const TerrainOptions& options = {});
  ~Terrain();
  Terrain(Terrain&&) noexcept;
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  /// From now on these walkers are on that ground; their pose follows it from the next update on. All or none. Errors:
  /// a stale handle, a posed person (Status::missing); nothing has changed.
  Result<void> manage(std::span<const Entity> people);
  /// No more: from the next tick on they walk on the plane y = 0. All or none. Errors: a stale handle, somebody who is
  /// not managed (Status::missing).
  Result<void> release(std::span<const Entity> people);
  /// From the next answers on. Who is slowed and should no more be goes on as asked within a step.
  void set_options(const TerrainOptions& options) { options_ = options; }

  /// Asks for the ground of those whose next foothold is new, or whose ground is not known: who was placed elsewhere,
  /// who woke. Call it before each tick, last. Takes memory where more people are asked for at once than ever before.
  TerrainReport update();

  /// The halves of `update`, for a host whose ground is not a function: it lies in another language, or is looked up by
  /// jobs of its own. `ask` gives the places, and changes nothing; they are good until the next call of this object.
  std::span<const TerrainQuery> ask();
  /// The ground at the places of the last `ask`, in their order, once, and before the next tick: a foot jumps that
  /// hears later how high its foothold is. Who has gone or taken a step since then is left as they are, and asked for
  /// again. Errors: not as many as were asked for (Status::not_valid); nothing has changed.
  Result<TerrainReport> answer(std::span<const TerrainHeight> heights);

 private:
  struct Work;
  Simulation& simulation_;
  TerrainHeights heights_;
  TerrainOptions options_;
  std::unique_ptr<Work> work_;
};

}  // namespace mobil::inline v0_3
