#pragma once
// Root motion: people's positions and headings on the ground, for driving capsules, agents or animation graphs.
//
//   simulation.roots(people, before, alpha_before * tick_s);     // after the game's own changes: place, spawn
//   const Ticks ticks = simulation.advance(frame_s);
//   simulation.roots(people, after, ticks.alpha * tick_s);
//   root_motion(before[i], after[i]);                            // ahead, left and turn

#include <span>

#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

struct SleepTime;
class World;

/// Position of a person on the ground, m, and heading (rad about +Y, 0 toward +Z, positive to the left; not wrapped).
/// It is the midpoint of the hips on the walking line, without sway; a steady walker's root moves at constant speed
/// (systems/gait/root_place.h). The root of a posed person is the point under the pelvis and the heading of the pelvis.
struct Root {
  double x_m = 0, z_m = 0;
  float heading_rad = 0;
};

/// Motion from one root to another, in the frame of the first: left and ahead, m, and the turn, rad, positive to the
/// left. Successive motions compose to the motion from the first root to the last.
struct RootMotion {
  float left_m = 0, ahead_m = 0, turn_rad = 0;
};
RootMotion root_motion(const Root& from, const Root& to);
/// Returns a root after a motion.
Root moved(const Root& from, const RootMotion& by);

/// Writes the roots of `people`, in their order, `ahead_s` after the last tick (0 to 0.2 s), also of compact people and
/// sleepers. `time` is that of the world. A person takes 20 ns if consecutive people are of one block (all people in
/// the order of rows), up to sixteen times as long if not, and some microseconds asleep. Allocates for sleepers only.
/// Errors, before anything is written: a stale handle, a time out of range, spans of different lengths.
Result<void> read_roots(const World& world, std::span<const Entity> people, const SleepTime& time, double ahead_s,
                        std::span<Root> out);

}  // namespace mobil::inline v0_3
