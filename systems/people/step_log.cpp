#include <mobil/systems/people/step_log.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/sleep.h>
#include <mobil/components/step_plan.h>
#include <mobil/each.h>
#include <mobil/engine/access.h>
#include <mobil/schedule.h>
#include <mobil/systems/people/sleepers.h>
#include "engine/snapshot.h"
#include "systems/gait/gait.h"
#include "systems/gait/step_events.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

/// Runs before the clocks advance.
void watch_ahead(Previous<StepPlan> plan, Previous<GaitState> state, Published<StepEvents> events, float tick_s) {
  begin_step_events(*plan, *state, tick_s, events.row);
}

void watch_behind(const StepPlan<Lanes<float>>& plan, const GaitState<Lanes<float>>& state,
                  Published<StepEvents> events, float tick_s) {
  end_step_events(plan, state, tick_s, events.row);
}

/// Checks that only walkers, awake or asleep, have step events.
Result<void> check_step_events_archetype(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool awake = !has(type_id<StepEvents>()) || has(type_id<GaitState<float>>());
  const bool asleep = !has(type_id<SleepsWithStepEvents>()) || has(type_id<Asleep<float>>());
  if (awake && asleep) return {};
  return damaged("whose steps are watched");
}

/// Returns the maximum number of a person's events: three a step, at up to two steps a tick and six steps a second.
std::size_t max_events(std::uint32_t ticks, float tick_s) {
  const double steps = std::min(2.0 * ticks, 6.0 * ticks * static_cast<double>(tick_s)) + 1;
  return static_cast<std::size_t>(std::ceil(3 * steps));
}

/// Returns the height of the ground at an event and the offset of its foothold, from a walker's footing after the tick.
Vec3<float> ground_of(const StepEvents::One& one, const Footing<Lanes<float>>& footing, std::uint32_t stance_side,
                      std::size_t lane) {
  FootholdOf where = FootholdOf::stance;
  if (one.kind == StepEventKind::toe_off) where = FootholdOf::leaving;
  if (one.kind == StepEventKind::heel_strike && one.side != stance_side) where = FootholdOf::landing;
  const std::size_t i = index(where);
  const bool of_foot = one.kind == StepEventKind::heel_strike || one.kind == StepEventKind::toe_off;
  return {of_foot ? footing.moved_x_m[i][lane] : 0.0F, footing.height_m[i][lane],
          of_foot ? footing.moved_z_m[i][lane] : 0.0F};
}

}  // namespace

Module step_events_module() {
  return {
      .name = "step events",
      .parts = {component_id(Publishes<StepEvents>{}), component_id(TagValue<SleepsWithStepEvents>{})},
      .systems =
          [](ScheduleBuilder& systems) {
            systems.add("steps ahead", &watch_ahead).add("step events", &watch_behind).after("steps ahead");
          },
      .after = {{"step events",
                 [](const Frame& frame) { frame.workspace.get<StepLog>().take(frame.tick.index, frame.tick.dt_s); }}},
      .check_key = &check_step_events_archetype};
}

Module step_memory_module() {
  return {.name = "memory of step events", .before = {{"memory of step events", [](const Frame& frame) {
                                                         frame.workspace.get<StepLog>().prepare(frame.world,
                                                                                                frame.tick.dt_s);
                                                       }}}};
}

bool has_step_events(const World& world, Entity person) {
  return world.has<StepEvents>(person) || world.has<SleepsWithStepEvents>(person);
}

Status enable_step_events(World& world, const Jobs& jobs, std::span<const Entity> people, bool on) {
  std::vector<Entity> changes;
  for (const Entity person : people) {
    if (!is_person(world, person)) return Status::stale_entity;
    if (is_posed(world, person)) return Status::missing;
    if (has_step_events(world, person) != on) changes.push_back(person);
  }
  World::Transaction transaction(world, jobs);
  group_by_table(world, changes, [&](std::span<const Entity> together) {
    const bool asleep = is_asleep(world, together.front());
    const auto part = asleep ? part_value(TagValue<SleepsWithStepEvents>{1}) : part_value(Publishes<StepEvents>{});
    const std::array owned = {part.part.id};
    world.change_archetype(together, std::span(&part, on ? 1 : 0), owned, jobs);
  });
  transaction.commit();
  return Status::ok;
}

void StepLog::prepare(World& world, float tick_s) {
  std::size_t watched = 0;
  for (const Table* const table : tables_.find(world)) watched += table->row_count();
  const std::size_t usual = watched * max_events(max_ticks_, tick_s),
                    needed = events_.size() + watched * StepEvents::most;
  if (events_.capacity() < usual) events_.reserve(usual);
  if (events_.capacity() < needed) events_.reserve(std::max(needed, 2 * events_.capacity()));
}

void StepLog::take(std::uint32_t tick, float tick_s) {
  const auto first = static_cast<std::ptrdiff_t>(events_.size());
  const float part = 1.0F / static_cast<float>(clock_units(tick_s).per_tick);
  for (const Table* const one_of : tables_.found()) {
    const Table& table = *one_of;
    const std::size_t column = table.column(type_id<StepEvents>()) * lane_count;
    const TableColumn<Footing> footing(table);
    const TableColumn<GaitState> state(table);
    for (std::size_t b = 0; b < table.block_count(); ++b) {
      const auto* const rows = reinterpret_cast<const StepEvents*>(table.block(b) + column);
      const std::uint32_t live = (std::uint32_t{1} << table.live(b)) - 1;
      for (std::uint32_t left = rows[0].telling & live; left != 0; left &= left - 1) {
        const auto l = static_cast<std::size_t>(std::countr_zero(left));
        for (std::uint32_t i = 0; i < rows[l].count; ++i) {
          const StepEvents::One& one = rows[l].of[i];
          const Vec3<float> over = footing ? ground_of(one, footing.at(table, b), state.at(table, b).stance_side[l], l)
                                           : Vec3<float>{0, 0, 0};
          events_.push_back({table.entities(b)[l], one.kind, static_cast<Side>(one.side), tick,
                             static_cast<float>(one.at) * part, Vec3<float>{one.x_m + over.x, over.y, one.z_m + over.z},
                             one.heading_rad});
        }
      }
    }
  }
  const auto order = [](const StepEvent& e) {
    return std::tuple(e.part, e.person.index, e.kind);  // events of earlier ticks are sorted already
  };
  std::sort(events_.begin() + first, events_.end(),
            [&](const StepEvent& a, const StepEvent& b) { return order(a) < order(b); });
}

}  // namespace mobil::inline v0_3
