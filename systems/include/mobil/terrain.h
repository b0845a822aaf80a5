#pragma once
// Walkers on ground that is not level: slopes, kerbs, stairs, fields. A host answers how high the ground is; feet then
// stand on it, tilted as it is, and pass over what lies between two footholds.
//
//   Simulation simulation;
//   simulation.terrain().set_heights([&](std::span<const TerrainQuery> at, std::span<TerrainHeight> out) {
//     for (std::size_t i = 0; i < at.size(); ++i) out[i].height_m = my_world.height(at[i].x_m, at[i].z_m);
//   });
//   simulation.terrain().manage({&person, 1});
//   simulation.advance(frame_seconds);
//
// The ground is asked for once a step and person: under the foothold to come and a little behind and ahead of it, for
// feet keep clear of edges, and along the way of the foot to it. The
// answers are state on the person's row (mobil/components/footing.h), so a restored world uses the same ones. Who is
// not managed walks on the plane y = 0 and costs what they did.

#include <cstddef>
#include <functional>
#include <span>

#include <mobil/components/footing.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/phase.h>

namespace mobil::inline v0_3 {

/// Where the ground is asked for, m, and by whom.
struct TerrainQuery {
  float x_m, z_m;
  Entity person;
};

/// The ground there: its height, m; how much it rises toward +X and toward +Z, m per m. Of a normal n: −n.x/n.y and
/// −n.z/n.y.
struct TerrainHeight {
  float height_m = 0, rise_x = 0, rise_z = 0;
};

/// Answers all queries of a tick at once, on the thread that ticks; `out` is as long and all zero. Heights within ±100
/// km; rises within ±1, steeper ones are taken as that. Instead of an answer that is not a number the plane of another
/// under the same sole is taken, or level ground at the height of the last foothold. Must not change the simulation.
/// A run can be repeated if the same places get the same answers.
using TerrainHeights = std::function<void(std::span<const TerrainQuery> at, std::span<TerrainHeight> out)>;

/// What became of the ground in all ticks of the last `advance` or `tick`: people on it in the last of them; how often
/// somebody's ground was asked for, at how many places; and how many answers were not numbers or out of range.
struct TerrainReport {
  std::size_t people = 0, asked = 0, places = 0, unusable = 0;
};

/// `slows_down`: walkers slow down on slopes and stairs (assets/gait/slope_pace.h), one step after their feet come
/// there, and go on as asked where it is level. Their Gait then is the slower one; a gait asked for meanwhile is one
/// for level ground. Avoidance slows what it wants.
struct TerrainOptions {
  bool slows_down = false;
};

struct TerrainWork;  // systems/terrain/terrain.cpp

/// The ground of a simulation (Simulation::terrain). Each tick asks for the ground of those whose next foothold is new,
/// or whose ground is not known: who was placed elsewhere, who woke. Takes memory where more people are asked for at
/// once than ever before.
class Terrain {
 public:
  explicit Terrain(const Frame& frame) : frame_(frame) {}

  /// Answers from now on. Without a function, or with an empty one, ticks ask nothing: use `ask` and `answer`. It is no
  /// state: a simulation that restores a snapshot keeps its own.
  void set_heights(TerrainHeights heights);
  /// From the next answers on. Who is slowed and should no more be goes on as asked within a step.
  void set_options(const TerrainOptions& options);

  /// From now on these walkers are on that ground; their pose follows it from the next tick on. All or none. Errors: a
  /// stale handle, a posed person (Status::missing); nothing has changed.
  Result<void> manage(std::span<const Entity> people);
  /// No more: from the next tick on they walk on the plane y = 0. All or none. Errors: a stale handle, somebody who is
  /// not managed (Status::missing).
  Result<void> release(std::span<const Entity> people);

  /// For a host whose ground is not a function: it lies in another language, or is looked up by jobs of its own. Gives
  /// the places of the next tick, and changes nothing; they are good until the next call of this kind.
  std::span<const TerrainQuery> query();
  /// The ground at the places of the last `ask`, in their order, once, and before the next tick: a foot jumps that
  /// hears later how high its foothold is. Until then the last height holds. Who has gone or taken a step since then is
  /// left as they are, and asked for again. Returns how many answers were unusable. Errors: not as many as were asked
  /// for (Status::not_valid); nothing has changed.
  Result<std::size_t> resolve(std::span<const TerrainHeight> heights);

  /// What was asked in all ticks of the last `advance` or `tick`.
  const TerrainReport& report() const;

 private:
  TerrainWork& work() const;

  Frame frame_;
};

}  // namespace mobil::inline v0_3
