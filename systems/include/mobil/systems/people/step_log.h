#pragma once
// People whose steps are watched: what happened in them, when and where, for sounds, dust, footprints and a game's own
// counting. Who is not watched pays nothing.

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/status.h>
#include <mobil/engine/table_list.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/step_event.h>

namespace mobil::inline v0_3 {

/// Publishes<StepEvents> of who is awake, SleepsWithStepEvents of who sleeps.
Module step_events_module();
/// Takes memory for the events of a tick: the last module, for phases before it may change who is watched.
Module step_memory_module();

/// Whether a person's steps are watched; false for a stale handle.
bool has_step_events(const World& world, Entity person);
/// People, named once each, are watched from the next tick on, or no more; who is so already is left alone. All or
/// none: Status::missing where one is posed.
Status enable_step_events(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);

/// What happened in the ticks since it was cleared, in order of time, at one time in the order of handles.
class StepLog {
 public:
  explicit StepLog(std::pmr::memory_resource* memory) : events_(memory), tables_({type_id<StepEvents>()}, memory) {}

  /// Forgets all events.
  void clear() { events_.clear(); }
  /// The longest `advance`, in ticks.
  void plan_for(std::uint32_t ticks) { max_ticks_ = ticks; }
  /// Before a tick: takes memory where more people are watched than ever before, for the longest `advance`, and where a
  /// longer `tick(n)` has had more events.
  void prepare(World& world, float tick_s);
  /// After the tick has run: `tick` is its number, from 1 on. Takes no memory.
  void take(std::uint32_t tick, float tick_s);
  std::span<const StepEvent> events() const { return events_; }

 private:
  std::pmr::vector<StepEvent> events_;
  TableList tables_;  // those with StepEvents
  std::uint32_t max_ticks_ = 1;
};

}  // namespace mobil::inline v0_3
