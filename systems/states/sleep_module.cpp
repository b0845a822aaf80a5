#include "systems/states/sleep_module.h"

#include <cstring>

#include <mobil/anthropometry.h>
#include <mobil/rows.h>
#include <mobil/schedule.h>
#include <mobil/systems/people/sleepers.h>
#include "engine/snapshot.h"
#include "systems/gait/asleep.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

void work_out(Asleep<Lanes<float>>& asleep, Unsettled<Lanes<float>>& since, const GaitStyleOf<Lanes<float>>& style,
              float tick_s) {
  WalkingBlock block{};
  Gait<Lanes<float>> gait_before;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Asleep<float> one = row_of(asleep, l);
    const GaitStyle its = row_of(style, l);
    const BodySize<float> size = size_of(one);
    put_row(size, block.size, l);
    put_row(gait_of(size.leg_scale_m, one.walk, its), block.gait, l);
    put_row(gait_of(size.leg_scale_m, row_of(since.before, l), its), gait_before, l);
  }
  SteadyWalk<Lanes<float>> after = asleep.walk;
  settle(gait_before, since.before, since.asked_tick, tick_s, block, after, since.until_tick);
  asleep.walk = after;
}

std::uint32_t lanes_unsettled(const Unsettled<Lanes<float>>& since) {
  std::uint32_t lanes = 0;
  for (std::size_t l = 0; l < lane_count; ++l) lanes |= static_cast<std::uint32_t>(since.until_tick[l] == 0) << l;
  return lanes;
}

void settle_sleepers(Asleep<Lanes<float>>& asleep, Unsettled<Lanes<float>>& since,
                     const SleepingStyle<Lanes<float>>& packed, float tick_s) {
  GaitStyleOf<Lanes<float>> style;
  for (std::size_t l = 0; l < lane_count; ++l) put_row(style_of(row_of(packed, l)), style, l);
  work_out(asleep, since, style, tick_s);
}

void settle_own_styles(Asleep<Lanes<float>>& asleep, Unsettled<Lanes<float>>& since, const OwnStyle<Lanes<float>>& own,
                       float tick_s) {
  work_out(asleep, since, own.style, tick_s);
}

/// Checks that a sleeper has exactly one style and no components of walkers.
Result<void> check_sleeper_key(const Archetype& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_component(key, id) != nullptr; };
  const bool asleep = has(type_id<Asleep<float>>());
  const bool packed = has(type_id<SleepingStyle<float>>()), own = has(type_id<OwnStyle<float>>());
  const bool others =
      has(type_id<Unsettled<float>>()) || has(type_id<SleepsWithForces>()) || has(type_id<SleepsManaged>());
  const bool sound = asleep ? packed != own && !has(type_id<BodySize<float>>()) && !has(type_id<Gait<float>>())
                            : !packed && !own && !others;
  if (sound) return {};
  return damaged("the parts of a sleeper");
}

bool is_sound(const SteadyWalk<float>& walk) {
  return walk.step_units > 0 && walk.step_units < (1U << 23U) && walk.clock < 2 * walk.step_units;
}

/// Checks the body and the clocks of each saved sleeper.
Result<void> check_sleepers(const SavedWorld& saved, std::uint32_t table) {
  const std::uint32_t first = saved.column(table, type_id<Asleep<float>>());
  const std::uint32_t since = saved.column(table, type_id<Unsettled<float>>());
  if (first == Table::no_column) return {};
  const auto read = [&](std::uint32_t row, std::uint32_t column, auto& out) {
    for (std::uint32_t w = 0; w < sizeof(out) / 4; ++w) {
      const std::uint32_t word = saved.word(table, row, column + w);
      std::memcpy(reinterpret_cast<std::byte*>(&out) + std::size_t{4} * w, &word, 4);
    }
  };
  for (std::uint32_t row = 0; row < saved.tables[table].rows; ++row) {
    Asleep<float> asleep;
    read(row, first, asleep);
    // Files from before fat depended on sex keep their values.
    bool sound = is_sound(asleep.walk) && check_body(body_of(asleep)).has_value() && asleep.fat_share >= 0.02F &&
                 asleep.fat_share <= 0.7F;
    if (since != Table::no_column) {
      Unsettled<float> unsettled;
      read(row, since, unsettled);
      sound = sound && is_sound(unsettled.before);
    }
    if (!sound) return damaged("a sleeper");
  }
  return {};
}

}  // namespace

Module sleep_module() {
  return {.name = "sleep",
          .parts = {component_id<Asleep>(), component_id<SleepingStyle>(), component_id<OwnStyle>(),
                    component_id<Unsettled>(), component_id(TagValue<SleepsWithForces>{}),
                    component_id(TagValue<SleepsManaged>{})},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add_packed("sleepers' steps", &lanes_unsettled, &settle_sleepers)
                    .add_packed("sleepers' own steps", &lanes_unsettled, &settle_own_styles)
                    .after("sleepers' steps");
              },
          .check_key = &check_sleeper_key,
          .check_rows = &check_sleepers};
}

}  // namespace mobil::inline v0_3
