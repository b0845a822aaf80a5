#pragma once
// Step events of people with Feature::step_events, for sounds, dust, footprints and a game's own counting. Other people
// cost nothing.

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/table_list.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/step_event.h>

namespace mobil::inline v0_3 {

/// Returns the module with Publishes<StepEvents> for awake people and SleepsWithStepEvents for sleepers.
Module step_events_module();
/// Returns the module that reserves memory for events: the last one, because earlier phases can enable the feature.
Module step_memory_module();

/// Returns true if a person has step events; false for a stale handle.
bool has_step_events(const World& world, Entity person);
/// Switches step events of people on or off from the next tick on, each named once. People who have that setting
/// already are unchanged. All or none. Errors: a posed person (Status::missing).
Status enable_step_events(World& world, const Jobs& jobs, std::span<const Entity> people, bool on);

/// Events of the ticks since the last `clear`, by time and then by handle.
class StepLog {
 public:
  explicit StepLog(std::pmr::memory_resource* memory) : events_(memory), tables_({type_id<StepEvents>()}, memory) {}

  /// Removes all events.
  void clear() { events_.clear(); }
  /// Sets the maximum number of ticks of an `advance`.
  void plan_for(std::uint32_t ticks) { max_ticks_ = ticks; }
  /// Reserves memory before a tick, enough for the longest `advance`. It grows only if more people have step events
  /// than before, or a longer `tick(n)` had more events.
  void prepare(World& world, float tick_s);
  /// Collects the events after a tick. `tick` is its number, from 1 on. Does not allocate.
  void take(std::uint32_t tick, float tick_s);
  std::span<const StepEvent> events() const { return events_; }

 private:
  std::pmr::vector<StepEvent> events_;
  TableList tables_;  // those with StepEvents
  std::uint32_t max_ticks_ = 1;
};

}  // namespace mobil::inline v0_3
