#include <mobil/systems/people/sleepers.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include <mobil/components/avoidance.h>
#include <mobil/each.h>
#include <mobil/rows.h>
#include "assets/body/body_scales.h"
#include "engine/state_hash.h"
#include "systems/gait/asleep.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

/// Sixteen walkers to check for a steady walk.
struct Candidates {
  WalkingBlock walkers;
  SteadyWalk<Lanes<float>> walk;
  Lanes<std::uint32_t> tick;
};

/// Reads only the fields of a step plan that decide if it is steady; a whole plan is a thousand cache lines.
bool read_times(const World& world, Entity person, StepPlan<float>& plan) {
  const auto place = world.find(person);
  if (!place) return false;
  const std::uint32_t column = place.table->column(type_id<StepPlan<float>>());
  if (column == Table::no_column) return false;
  using Plan = StepPlan<float>;
  constexpr std::size_t from = offsetof(Plan, from), to = offsetof(Plan, to),
                        strike = offsetof(HeelStrike<float>, shape);
  for (const auto& [first, bytes] : {std::pair{std::size_t{0}, from}, std::pair{from, strike}, std::pair{to, strike}})
    place.table->read(place.row, column + static_cast<std::uint32_t>(first / 4), static_cast<std::uint32_t>(bytes / 4),
                      reinterpret_cast<std::byte*>(&plan) + first);
  return true;
}

/// Moves a walk's anchor to the walker's place at that tick, minus (x, 0, z).
void shift(SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s, float x_m, float z_m) {
  GaitState<Lanes<float>> state;
  steady_state(walk, tick, tick_s, state);
  for (std::size_t l = 0; l < lane_count; ++l) {
    walk.anchor_x_m[l] = state.line_x_m[l] - x_m;
    walk.anchor_z_m[l] = state.line_z_m[l] - z_m;
  }
  walk.anchor_steps = state.steps;
}

/// Straightens sleepers' shoulders, which nothing turns back in sleep; sleepers must wake in the pose that was drawn.
void face_their_way(World& world, std::span<const Entity> people) {
  const auto avoids = [](Table& table) { return static_cast<bool>(TableColumn<AvoidanceState>(table)); };
  if (std::ranges::none_of(world.tables(), avoids)) return;
  for (const Entity person : people) {
    auto course = world.get<AvoidanceState>(person);
    if (!course) continue;
    course->turn_rad = course->turn_rad_s = course->turn_to_rad = 0;
    world.set(person, *course);
  }
}

}  // namespace

BodyRequest body_of(const Asleep<float>& asleep) {
  return {asleep.height_m,
          asleep.mass_kg,
          {asleep.endo, asleep.meso, asleep.ecto},
          constitution_of(asleep.build),
          {},
          sex_of(asleep.build),
          age_of(asleep.build)};
}

BodySize<float> size_of(const Asleep<float>& asleep) {
  return make_size(body_of(asleep), asleep.fat_share);
}

Gait<float> gait_of(float leg_scale_m, const SteadyWalk<float>& walk, const GaitStyle& style) {
  Gait<float> gait = complete_gait(leg_scale_m, walk.speed_m_s, walk.step_length_m, style);
  gait.heading_rad = walk.asked_heading_rad;
  gait.revision = walk.requests & 0xFFFFU;
  gait.displacement = walk.requests >> 16U;
  return gait;
}

GaitStyle sleeper_style(const World& world, Entity person) {
  if (const auto own = world.get<OwnStyle>(person)) return own->style;
  return style_of(*world.get<SleepingStyle>(person));
}

bool is_unsettled(const std::optional<Unsettled<float>>& since, const SleepTime& time) {
  return since && (since->until_tick == 0 || since->until_tick > time.tick);
}

std::optional<Unsettled<float>> unsettled_of(const World& world, Entity person) {
  const auto since = world.get<Unsettled>(person);
  return since ? std::optional(*since) : std::nullopt;
}

bool is_asleep(const World& world, Entity person) {
  return world.has<Asleep>(person);
}

BodyRequest sleeper_body(const World& world, Entity person) {
  return body_of(*world.get<Asleep>(person));
}

Gait<float> sleeper_gait(const World& world, Entity person) {
  const Asleep<float> asleep = *world.get<Asleep>(person);
  return gait_of(size_of(asleep).leg_scale_m, asleep.walk, sleeper_style(world, person));
}

void find_steady(const World& world, std::span<const Entity> people, const SleepTime& time, std::vector<Sleeper>& out) {
  const auto at = std::make_unique<Candidates>();
  for (auto& lane : at->tick.lane) lane = time.tick;
  std::array<Entity, lane_count> who;
  std::size_t count = 0;
  const auto look = [&] {
    for (std::size_t l = count; l < lane_count; ++l) {
      put_row(row_of(at->walkers.size, 0), at->walkers.size, l);
      put_row(row_of(at->walkers.gait, 0), at->walkers.gait, l);
      put_row(row_of(at->walkers.plan, 0), at->walkers.plan, l);
      put_row(row_of(at->walkers.state, 0), at->walkers.state, l);
    }
    const std::uint32_t steady = steady_walkers(at->walkers.size, at->walkers.gait, at->walkers.plan, at->walkers.state,
                                                at->tick, time.tick_s, at->walk);
    for (std::size_t l = 0; l < count; ++l) {
      if ((steady >> l & 1U) == 0) continue;
      const Physique<float> body = *world.get<Physique>(who[l]);
      const GaitStyle style = row_of(at->walkers.gait, l).style;
      out.push_back({who[l],
                     {row_of(at->walk, l), at->walkers.size.height_m[l], at->walkers.size.mass_kg[l],
                      at->walkers.size.fat_share[l], body.endo, body.meso, body.ecto, body.build},
                     packed_style(style),
                     {style}});
    }
    count = 0;
  };
  for (const Entity person : people) {
    StepPlan<float> plan{};
    if (!read_times(world, person, plan)) continue;  // posed, asleep or gone
    put_row(*world.get<BodySize>(person), at->walkers.size, count);
    put_row(*world.get<Gait>(person), at->walkers.gait, count);
    put_row(plan, at->walkers.plan, count);
    put_row(*world.get<GaitState>(person), at->walkers.state, count);
    who[count++] = person;
    if (count == lane_count) look();
  }
  if (count > 0) look();
}

void put_to_sleep(World& world, const Jobs& jobs, std::span<const Sleeper* const> sleepers,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, FallingAsleep& work) {
  if (sleepers.empty()) return;
  const std::size_t blocks = (sleepers.size() + lane_count - 1) / lane_count;
  const bool packed = sleepers.front()->style.has_value();
  work.people.clear();
  work.asleep.resize(blocks);
  packed ? work.style.resize(blocks) : work.own_style.resize(blocks);
  for (std::size_t i = 0; i < sleepers.size(); ++i) {
    const Sleeper& one = *sleepers[i];
    const std::size_t b = i / lane_count, l = i % lane_count;
    work.people.push_back(one.entity);
    put_row(one.asleep, work.asleep[b], l);
    packed ? put_row(*one.style, work.style[b], l) : put_row(one.own_style, work.own_style[b], l);
  }
  work.parts.assign({{component_id<Asleep>(), work.asleep.data()},
                     packed ? PartValue{component_id<SleepingStyle>(), work.style.data()}
                            : PartValue{component_id<OwnStyle>(), work.own_style.data()}});
  for (const ComponentId& part : more) work.parts.push_back({part, nullptr});
  world.change_archetype(work.people, work.parts, owned, jobs);
  face_their_way(world, work.people);
}

bool is_busy(const World& world, Entity person, const SleepTime& time) {
  const auto since = unsettled_of(world, person);
  return is_unsettled(since, time) && since->until_tick != 0;
}

void ask_sleepers(World& world, const Jobs& jobs, std::span<const AskedSleeper> asked, const SleepTime& time) {
  constexpr std::uint32_t none = ~0U;
  struct Begins {
    std::uint32_t table;
    Entity entity;
  };
  std::vector<Begins> begins(asked.size());  // steady sleepers and their tables
  in_parallel(jobs, asked.size(), [&](std::size_t first, std::size_t last) {
    for (; first < last; ++first) {
      const Entity one = asked[first].entity;
      const auto since = unsettled_of(world, one);
      begins[first] = {since ? none : world.locate(one)->table, one};
      if (since && since->until_tick != 0)  // steady again; 0 after an earlier request in this tick
        world.set(one, Unsettled<float>{world.get<Asleep>(one)->walk, time.tick, 0});
    }
  });
  std::erase_if(begins, [](const Begins& one) { return one.table == none; });
  std::ranges::stable_sort(begins, {}, &Begins::table);
  std::vector<Entity> people;
  std::vector<Unsettled<Lanes<float>>> since;
  for (auto first = begins.begin(); first != begins.end();) {
    const auto end = std::find_if(first, begins.end(), [&](const Begins& one) { return one.table != first->table; });
    people.clear();
    for (; first != end; ++first) people.push_back(first->entity);
    since.resize((people.size() + lane_count - 1) / lane_count);
    in_parallel(jobs, since.size(), [&](std::size_t block, std::size_t last) {
      for (; block < last; ++block) {
        for (std::size_t l = 0; l < lane_count && block * lane_count + l < people.size(); ++l)
          put_row(Unsettled<float>{world.get<Asleep>(people[block * lane_count + l])->walk, time.tick, 0}, since[block],
                  l);
      }
    });
    world.change_archetype(people, std::array{PartValue{component_id<Unsettled>(), since.data()}}, {}, jobs);
  }
  in_parallel(jobs, asked.size(), [&](std::size_t begin, std::size_t end) {
    for (; begin < end; ++begin) {
      const auto& [entity, gait] = asked[begin];
      const auto place = world.find(entity);
      SteadyWalk<float> walk{};
      walk.asked_heading_rad = gait.heading_rad;
      walk.speed_m_s = gait.speed_m_s;
      walk.step_length_m = gait.step_length_m;
      walk.requests = gait.revision | gait.displacement << 16U;
      constexpr std::size_t first = offsetof(SteadyWalk<float>, asked_heading_rad) / 4;
      place.table->write(place.row, place.table->column(type_id<Asleep<float>>()) + first, sizeof(walk) / 4 - first,
                         &walk.asked_heading_rad);
    }
  });
}

void end_unsettled(World& world, const Jobs& jobs, const SleepTime& time, UnsettledTables& tables,
                   std::vector<Entity>& work, std::vector<Entity>& restless) {
  constexpr std::uint32_t rounds = 16;  // ticks in which each block is checked once
  constexpr std::array part = {type_id<Unsettled<float>>()};
  for (; tables.seen < world.tables().size(); ++tables.seen) {
    const Table& table = world.tables()[tables.seen];
    if (!TableColumn<Unsettled>(table)) continue;
    tables.by_hash.emplace_back(key_hash(world, table.key()), static_cast<std::uint32_t>(tables.seen));
    std::ranges::sort(tables.by_hash);
  }
  for (const auto& [hash, number] : tables.by_hash) {
    const Table& table = world.tables()[number];
    const TableColumn<Unsettled> column(table);
    work.clear();
    for (std::size_t b = time.tick % rounds; b < table.block_count(); b += rounds) {
      const Lanes<std::uint32_t>& until = column.at(table, b).until_tick;
      for (std::uint32_t l = 0; l < table.live(b); ++l) {
        if (until[l] == never_settles) restless.push_back(table.entities(b)[l]);
        if (until[l] != 0 && until[l] <= time.tick) work.push_back(table.entities(b)[l]);
      }
    }
    world.change_archetype(work, {}, part, jobs);
  }
}

void shift_sleepers(World& world, const SleepTime& time, float x_m, float z_m) {
  for (Table& table : world.tables()) {
    const TableColumn<Asleep> asleep(table);
    const TableColumn<Unsettled> unsettled(table);
    for (std::size_t b = 0; asleep && b < table.block_count(); ++b) {
      Lanes<std::uint32_t> tick;
      for (auto& lane : tick.lane) lane = time.tick;
      if (unsettled) {
        Unsettled<Lanes<float>>& since = unsettled.at(table, b);
        shift(since.before, since.asked_tick, time.tick_s, x_m, z_m);
        for (std::size_t l = 0; l < lane_count; ++l)
          if (since.until_tick[l] != never_settles) tick[l] = std::max(tick[l], since.until_tick[l]);
      }
      shift(asleep.at(table, b).walk, tick, time.tick_s, x_m, z_m);
    }
  }
}

}  // namespace mobil::inline v0_3
