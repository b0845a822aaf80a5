#include "systems/people/sleepers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

#include "assets/body/anthropometry.h"
#include "components/leg_frames.h"
#include "components/pose.h"
#include "engine/access.h"
#include "engine/each.h"
#include "engine/rows.h"
#include "engine/snapshot.h"
#include "systems/gait/asleep.h"
#include "systems/kinematics/kinematics.h"
#include "systems/people/person.h"

namespace mobil {
namespace {

BodyRequest body_of(const Asleep<float>& asleep) {
  return {asleep.height_m,
          asleep.mass_kg,
          {asleep.endo, asleep.meso, asleep.ecto},
          static_cast<Constitution>(asleep.constitution),
          {}};
}

BodySize<float> size_of(const Asleep<float>& asleep) {
  return {asleep.height_m, asleep.mass_kg, asleep.extra_fat};
}

Gait<float> gait_of(float height_m, const SteadyWalk<float>& walk, const GaitStyle& style) {
  Gait<float> gait = complete_gait(height_m, walk.speed_m_s, walk.step_length_m, style);
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

/// Sleepers side by side who are walkers again.
struct WakingBlock {
  WalkingBlock walkers;
  Physique<Lanes<float>> physique;
  Gait<Lanes<float>> gait_before;
  SteadyWalk<Lanes<float>> before;
  Lanes<std::uint32_t> asked, tick;
  Pose<Lanes<float>> pose;
  JointAngles<Lanes<float>> angles;
  Feet<Lanes<float>> feet;
  CentreOfMass<Lanes<float>> centre;

  void put(const World& world, Entity person, const SleepTime& time, std::size_t lane) {
    const Asleep<float> asleep = *world.get<Asleep>(person);
    const GaitStyle style = sleeper_style(world, person);
    const BodyRequest body = body_of(asleep);
    put_row(size_of(asleep), walkers.size, lane);
    put_row(mobil::physique(body), physique, lane);
    const auto since = unsettled_of(world, person);
    const bool changing = is_unsettled(since, time);
    const SteadyWalk<float> from = changing ? since->before : asleep.walk;
    put_row(gait_of(body.height_m, asleep.walk, style), walkers.gait, lane);
    put_row(gait_of(body.height_m, from, style), gait_before, lane);
    put_row(from, before, lane);
    asked[lane] = changing ? since->asked_tick : time.tick;
    tick[lane] = time.tick;
  }
  void make(float tick_s) {
    const FlushDenormals flush;  // as in a tick
    walk_on(gait_before, before, asked, tick, tick_s, walkers);
    pose_skeleton(walkers.size, walkers.plan, walkers.state, pose, angles, feet);
    centre_of_mass(walkers.size, pose, centre);
  }
};

/// A lane as a row of its own.
struct WokenRow {
  BodySize<float> size;
  Physique<float> physique;
  Gait<float> gait;
  StepPlan<float> plan;
  GaitState<float> state;
  Pose<float> pose;
  JointAngles<float> angles;
  Feet<float> feet;
  CentreOfMass<float> centre;

  WokenRow(const WakingBlock& of, std::size_t lane)
      : size(row_of(of.walkers.size, lane)),
        physique(row_of(of.physique, lane)),
        gait(row_of(of.walkers.gait, lane)),
        plan(row_of(of.walkers.plan, lane)),
        state(row_of(of.walkers.state, lane)),
        pose(row_of(of.pose, lane)),
        angles(row_of(of.angles, lane)),
        feet(row_of(of.feet, lane)),
        centre(row_of(of.centre, lane)) {}

  std::array<PartValue, 10> parts() const {
    return {
        part_value(size), part_value(physique), part_value(gait), part_value(plan),   part_value(state),
        part_value(pose), part_value(angles),   part_value(feet), part_value(centre), part_value(Publishes<LegPost>{})};
  }
};

/// Of a step only what tells whether it is steady: all of it would be a thousand lines of memory.
bool read_times(const World& world, Entity person, StepPlan<float>& plan) {
  const auto place = world.find(person);
  if (!place) return false;
  const std::uint32_t column = place.table->column(type_id<StepPlan<float>>());
  if (column == Table::no_column) return false;
  using Plan = StepPlan<float>;
  constexpr std::size_t from = offsetof(Plan, from), to = offsetof(Plan, to), strike = offsetof(Strike<float>, shape);
  for (const auto& [first, bytes] : {std::pair{std::size_t{0}, from}, std::pair{from, strike}, std::pair{to, strike}})
    place.table->read(place.row, column + static_cast<std::uint32_t>(first / 4), static_cast<std::uint32_t>(bytes / 4),
                      reinterpret_cast<std::byte*>(&plan) + first);
  return true;
}

void work_out(Asleep<Lanes<float>>& asleep, Unsettled<Lanes<float>>& since, const GaitStyleOf<Lanes<float>>& style,
              float tick_s) {
  WalkingBlock block{};
  Gait<Lanes<float>> gait_before;
  for (std::size_t l = 0; l < lane_count; ++l) {
    const Asleep<float> one = row_of(asleep, l);
    const GaitStyle its = row_of(style, l);
    put_row(size_of(one), block.size, l);
    put_row(gait_of(one.height_m, one.walk, its), block.gait, l);
    put_row(gait_of(one.height_m, row_of(since.before, l), its), gait_before, l);
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

/// A sleeper has one style, and is no walker.
Result<void> check_sleeper_key(const TableKey& key, const World&) {
  const auto has = [&](std::uint64_t id) { return find_part(key, id) != nullptr; };
  const bool asleep = has(type_id<Asleep<float>>());
  const bool packed = has(type_id<SleepingStyle<float>>()), own = has(type_id<OwnStyle<float>>());
  const bool others =
      has(type_id<Unsettled<float>>()) || has(type_id<SleepsWithForces>()) || has(type_id<SleepsManaged>());
  const bool sound = asleep ? packed != own && !has(type_id<BodySize<float>>()) && !has(type_id<Gait<float>>())
                            : !packed && !own && !others;
  if (sound) return {};
  return fail("the snapshot does not agree with itself (the parts of a sleeper); give one that `save` made");
}

bool is_sound(const SteadyWalk<float>& walk) {
  return walk.step_units > 0 && walk.step_units < (1U << 23U) && walk.clock < 2 * walk.step_units;
}

/// Every body is one that can live, every clock goes.
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
    bool sound = is_sound(asleep.walk) && asleep.constitution <= static_cast<std::uint32_t>(Constitution::heavy) &&
                 check_body(body_of(asleep)).has_value() && asleep.extra_fat == body_size(body_of(asleep)).extra_fat;
    if (since != Table::no_column) {
      Unsettled<float> unsettled;
      read(row, since, unsettled);
      sound = sound && is_sound(unsettled.before);
    }
    if (!sound) return fail("the snapshot does not agree with itself (a sleeper); give one that `save` made");
  }
  return {};
}

/// A walk's anchor comes to be where it is at that tick, less (x, 0, z).
void shift(SteadyWalk<Lanes<float>>& walk, const Lanes<std::uint32_t>& tick, float tick_s, float x_m, float z_m) {
  GaitState<Lanes<float>> state;
  steady_state(walk, tick, tick_s, state);
  for (std::size_t l = 0; l < lane_count; ++l) {
    walk.anchor_x_m[l] = state.line_x_m[l] - x_m;
    walk.anchor_z_m[l] = state.line_z_m[l] - z_m;
  }
  walk.anchor_steps = state.steps;
}

}  // namespace

struct WakingWork::Blocks {
  static constexpr std::size_t most = 64;  // at once
  template <template <class> class C>
  using Column = std::array<C<Lanes<float>>, most>;

  Column<BodySize> size;
  Column<Physique> physique;
  Column<Gait> gait;
  Column<StepPlan> plan;
  Column<GaitState> state;
  Column<Pose> pose;
  Column<JointAngles> angles;
  Column<Feet> feet;
  Column<CentreOfMass> centre;
  std::vector<Entity> people;    // table by table
  std::vector<PartValue> parts;  // of a walker

  void set(std::size_t b, const WakingBlock& block) {
    size[b] = block.walkers.size;
    physique[b] = block.physique;
    gait[b] = block.walkers.gait;
    plan[b] = block.walkers.plan;
    state[b] = block.walkers.state;
    pose[b] = block.pose;
    angles[b] = block.angles;
    feet[b] = block.feet;
    centre[b] = block.centre;
  }
  void list_parts(std::span<const KeyPart> more) {
    parts = {{component_part<BodySize>(), size.data()},       {component_part<Physique>(), physique.data()},
             {component_part<Gait>(), gait.data()},           {component_part<StepPlan>(), plan.data()},
             {component_part<GaitState>(), state.data()},     {component_part<Pose>(), pose.data()},
             {component_part<JointAngles>(), angles.data()},  {component_part<Feet>(), feet.data()},
             {component_part<CentreOfMass>(), centre.data()}, part_value(Publishes<LegPost>{})};
    for (const KeyPart& part : more) parts.push_back({part, nullptr});
  }
};
WakingWork::WakingWork() = default;
WakingWork::~WakingWork() = default;

bool is_asleep(const World& world, Entity person) {
  return world.has<Asleep>(person);
}

BodyRequest sleeper_body(const World& world, Entity person) {
  return body_of(*world.get<Asleep>(person));
}

Gait<float> sleeper_gait(const World& world, Entity person) {
  const Asleep<float> asleep = *world.get<Asleep>(person);
  return gait_of(asleep.height_m, asleep.walk, sleeper_style(world, person));
}

void find_steady(const World& world, std::span<const Entity> people, const SleepTime& time, std::vector<Sleeper>& out) {
  const auto at = std::make_unique<WakingBlock>();
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
                                                at->tick, time.tick_s, at->before);
    for (std::size_t l = 0; l < count; ++l) {
      if ((steady >> l & 1U) == 0) continue;
      const Physique<float> body = *world.get<Physique>(who[l]);
      const GaitStyle style = row_of(at->walkers.gait, l).style;
      out.push_back({who[l],
                     {row_of(at->before, l), at->walkers.size.height_m[l], at->walkers.size.mass_kg[l],
                      at->walkers.size.extra_fat[l], body.endo, body.meso, body.ecto, body.constitution},
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
                  std::span<const KeyPart> more, std::span<const std::uint64_t> owned, FallingAsleep& work) {
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
  std::array<PartValue, 10> parts;
  std::size_t count = 0;
  parts[count++] = {component_part<Asleep>(), work.asleep.data()};
  parts[count++] = packed ? PartValue{component_part<SleepingStyle>(), work.style.data()}
                          : PartValue{component_part<OwnStyle>(), work.own_style.data()};
  for (const KeyPart& part : more)
    if (count < parts.size()) parts[count++] = {part, nullptr};
  world.remake_many(work.people, std::span(parts).first(count), owned, jobs);
}

void wake_walkers(World& world, const Jobs& jobs, std::span<const Entity> people, const SleepTime& time,
                  std::span<const KeyPart> more, std::span<const std::uint64_t> owned, WakingWork& work) {
  if (work.blocks == nullptr) work.blocks = std::make_unique<WakingWork::Blocks>();
  WakingWork::Blocks& blocks = *work.blocks;
  blocks.list_parts(more);
  blocks.people.assign(people.begin(), people.end());
  const auto table = [&](Entity person) { return world.locate(person)->table; };
  std::ranges::stable_sort(blocks.people, {}, table);
  for (std::span<const Entity> left = blocks.people; !left.empty();) {
    std::size_t count = 1;
    while (count < std::min(left.size(), WakingWork::Blocks::most * lane_count) && table(left[count]) == table(left[0]))
      ++count;
    const auto some = left.first(count);
    left = left.subspan(count);
    in_parallel(jobs, (count + lane_count - 1) / lane_count, [&](std::size_t begin, std::size_t end) {
      const auto block = std::make_unique<WakingBlock>();
      for (std::size_t b = begin; b < end; ++b) {
        for (std::size_t l = 0; l < lane_count; ++l) {
          const std::size_t i = b * lane_count + l;
          block->put(world, some[i < count ? i : b * lane_count], time, l);
        }
        block->make(time.tick_s);
        blocks.set(b, *block);
      }
    });
    world.remake_many(some, blocks.parts, owned, jobs);
  }
}

Status read_asleep(const World& world, Entity person, const SleepTime& time, std::uint64_t part, void* row) {
  if (!is_asleep(world, person)) return world.alive(person) ? Status::missing : Status::stale_entity;
  if (part == type_id<Gait<float>>()) {
    const Gait<float> gait = sleeper_gait(world, person);
    std::memcpy(row, &gait, sizeof(gait));
    return Status::ok;
  }
  const auto since = unsettled_of(world, person);
  if (part == type_id<GaitState<float>>() && !is_unsettled(since, time)) {
    Lanes<std::uint32_t> tick;
    for (auto& lane : tick.lane) lane = time.tick;
    GaitState<Lanes<float>> state;
    steady_state(broadcast(world.get<Asleep>(person)->walk), tick, time.tick_s, state);
    const GaitState<float> one = first_lane(state);
    std::memcpy(row, &one, sizeof(one));
    return Status::ok;
  }
  const auto block = std::make_unique<WakingBlock>();
  for (std::size_t l = 0; l < lane_count; ++l) block->put(world, person, time, l);
  block->make(time.tick_s);
  const WokenRow woken(*block, 0);
  for (const PartValue& value : woken.parts()) {
    if (value.part.id != part || value.row == nullptr) continue;
    std::memcpy(row, value.row, 4 * static_cast<std::size_t>(value.part.value));
    return Status::ok;
  }
  return Status::missing;
}

bool is_busy(const World& world, Entity person, const SleepTime& time) {
  const auto since = unsettled_of(world, person);
  return is_unsettled(since, time) && since->until_tick != 0;
}

void ask_sleeper(World& world, Entity person, const SleepTime& time, const Gait<float>& gait) {
  const auto since = unsettled_of(world, person);
  if (!since || since->until_tick != 0) {  // not yet asked for anything in this tick
    const Unsettled<float> begins = {world.get<Asleep>(person)->walk, time.tick, 0};
    since ? world.set(person, begins) : world.add(person, begins);
  }
  const auto place = world.find(person);
  SteadyWalk<float> asked{};
  asked.asked_heading_rad = gait.heading_rad;
  asked.speed_m_s = gait.speed_m_s;
  asked.step_length_m = gait.step_length_m;
  asked.requests = gait.revision | gait.displacement << 16U;
  constexpr std::size_t first = offsetof(SteadyWalk<float>, asked_heading_rad) / 4, words = sizeof(asked) / 4 - first;
  place.table->write(place.row, place.table->column(type_id<Asleep<float>>()) + first, words, &asked.asked_heading_rad);
}

void end_unsettled(World& world, const SleepTime& time, std::vector<Entity>& work, std::vector<Entity>& restless) {
  constexpr std::uint32_t rounds = 16;  // ticks in which everybody is looked at once
  work.clear();
  for (const Table& table : world.tables()) {
    const TableColumn<Unsettled> column(table);
    if (!column) continue;
    for (std::size_t b = time.tick % rounds; b < table.block_count(); b += rounds) {
      const Lanes<std::uint32_t>& until = column.at(table, b).until_tick;
      for (std::uint32_t l = 0; l < table.live(b); ++l) {
        if (until[l] == never_settles) restless.push_back(table.entities(b)[l]);
        if (until[l] != 0 && until[l] <= time.tick) work.push_back(table.entities(b)[l]);
      }
    }
  }
  for (const Entity person : work) world.remove<Unsettled>(person);
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

Module sleep_module() {
  return {.name = "sleep",
          .parts = {component_part<Asleep>(), component_part<SleepingStyle>(), component_part<OwnStyle>(),
                    component_part<Unsettled>(), key_part(TagValue<SleepsWithForces>{}),
                    key_part(TagValue<SleepsManaged>{})},
          .systems =
              [](ScheduleBuilder& systems) {
                systems.add_packed("sleepers' steps", &lanes_unsettled, &settle_sleepers)
                    .add_packed("sleepers' own steps", &lanes_unsettled, &settle_own_styles)
                    .after("sleepers' steps");
              },
          .check_key = &check_sleeper_key,
          .check_rows = &check_sleepers};
}

}  // namespace mobil
