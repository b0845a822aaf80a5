#pragma once
// People whose steps are watched: what happened in them, when and where, for sounds, dust, footprints and a game's own
// counting. Who is not watched pays nothing.

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/components/step_events.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/status.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// What happened in a walker's steps.
struct StepEvent {
  Entity person;
  StepEventKind kind;
  /// The foot that came to the ground or left it; that came down last before somebody stood; that goes first.
  Side side;
  /// Of which tick, from 1 on as Simulation::ticks counts, and what part of it was over, 0 to 1, to the unit of the
  /// walker's clock (a 32768th of a tick): (tick − 1 + part) · tick_s seconds after the beginning.
  std::uint32_t tick;
  float part;
  /// On the ground, m: of a foot the point under its ankle when it lies flat, the same as it comes down and as it
  /// leaves; of who stops or starts the point of the walking line.
  Vec3<float> place_m;
  /// Where the foot points, of who stops or starts the body; rad about +Y, 0 toward +Z, positive to the left.
  float heading_rad;
};

/// Publishes<StepEvents> of who is awake, SleepsWatched of who sleeps.
Module step_watch_module();

/// Whether a person's steps are watched; false for a stale handle.
bool is_watched(const World& world, Entity person);
/// People, named once each, are watched from the next tick on, or no more; who is so already is left alone. All or
/// none: Status::missing where one is posed.
Status watch_steps(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);

/// What happened in the ticks since it was cleared, in order of time, at one time in the order of handles.
class StepLog {
 public:
  explicit StepLog(std::pmr::memory_resource* memory) : events_(memory), tables_(memory) {}

  /// Forgets all events.
  void clear() { events_.clear(); }
  /// The longest `advance`, in ticks.
  void plan_for(std::uint32_t ticks) { most_ticks_ = ticks; }
  /// Before a tick: takes memory where more people are watched than ever before, for the longest `advance`, and where a
  /// longer `tick(n)` has had more events.
  void prepare(const World& world, float tick_s);
  /// After the tick has run: `tick` is its number, from 1 on. Takes no memory.
  void take(const World& world, std::uint32_t tick, float tick_s);
  std::span<const StepEvent> events() const { return events_; }

 private:
  std::pmr::vector<StepEvent> events_;
  std::pmr::vector<std::uint32_t> tables_;  // those with StepEvents
  std::size_t tables_seen_ = 0;
  std::uint32_t most_ticks_ = 1;
};

}  // namespace mobil::inline v0_3
