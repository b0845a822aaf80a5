#pragma once
// Root motion: how people go over the ground, for who drives a capsule, an agent or an animation graph by it.
//
//   simulation.roots(people, before, alpha_before * tick_s);     // after whatever the game did: place, spawn
//   const Ticks ticks = simulation.advance(frame_s);
//   simulation.roots(people, after, ticks.alpha * tick_s);
//   root_motion(before[i], after[i]);                            // ahead, to the left, and the turn

#include <span>

#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

struct SleepTime;
class World;

/// Where a person is on the ground, m, and where they head (rad about +Y, 0 toward +Z, positive to the left; not
/// wrapped): the middle of the hips on the walking line, without sway, for a steady walker at one speed
/// (systems/gait/root_place.h). Of who is animated by the host: under the pelvis, and where it faces.
struct Root {
  double x_m = 0, z_m = 0;
  float heading_rad = 0;
};

/// The way from one root to another, seen from the first: to its left, ahead of it, m; and by how much it turned, rad,
/// positive to the left. Ways one after the other, put together, are the way from the first to the last.
struct RootMotion {
  float left_m = 0, ahead_m = 0, turn_rad = 0;
};
RootMotion root_motion(const Root& from, const Root& to);
/// The other way round: where that leads from there.
Root moved(const Root& from, const RootMotion& by);

/// The roots of `people`, in their order, `ahead_s` after the last tick (0 to 0.2 s), compact and asleep too; `time`:
/// that of the world. People of a block who follow each other (all in the order of rows) take 20 ns each, others up to
/// sixteen times as long, sleepers some microseconds. Takes no memory but for sleepers. Errors, in one line, before
/// anything is written: a stale handle, a time out of range, spans that are not as long as each other.
Result<void> read_roots(const World& world, std::span<const Entity> people, const SleepTime& time, double ahead_s,
                        std::span<Root> out);

}  // namespace mobil::inline v0_3
