#include "systems/states/waking.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory_resource>
#include <new>
#include <type_traits>

#include <mobil/components/footing.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/pose.h>
#include <mobil/engine/interrupt.h>
#include <mobil/engine/scratch.h>
#include <mobil/rows.h>
#include "engine/exact_math.h"
#include "systems/gait/asleep.h"
#include "systems/gait/kinematics.h"
#include "systems/people/person_requests.h"

namespace mobil::inline v0_3 {
namespace {

/// Sixteen sleepers as walkers.
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
  Lanes<float> ground_m{};  // height of the ground under the stance foot on falling asleep
  WalkingBlock work;

  void put(const World& world, Entity person, const SleepTime& time, std::size_t lane) {
    const auto footing = world.get<Footing>(person);
    ground_m[lane] = footing ? footing->height_m[index(FootholdOf::stance)] : 0;
    put(*world.get<Asleep>(person), sleeper_style(world, person), unsettled_of(world, person), time, lane);
  }
  void put(const Asleep<float>& asleep, const GaitStyle& style, const std::optional<Unsettled<float>>& since,
           const SleepTime& time, std::size_t lane) {
    const BodyRequest body = body_of(asleep);
    const BodySize<float> size = size_of(asleep);
    put_row(size, walkers.size, lane);
    put_row(mobil::physique(body), physique, lane);
    const bool changing = is_unsettled(since, time);
    const SteadyWalk<float> from = changing ? since->before : asleep.walk;
    put_row(gait_of(size.leg_scale_m, asleep.walk, style), walkers.gait, lane);
    put_row(gait_of(size.leg_scale_m, from, style), gait_before, lane);
    put_row(from, before, lane);
    asked[lane] = changing ? since->asked_tick : time.tick;
    tick[lane] = time.tick;
  }
  void make(float tick_s, Woken as) {
    walk_on(gait_before, before, asked, tick, tick_s, walkers, work);
    if (as == Woken::compact) return;
    pose_skeleton(walkers.size, walkers.plan, walkers.state, nullptr, pose, angles, feet);
    centre_of_mass(walkers.size, pose, centre);
    raise();
  }

 private:
  /// Raises poses to that height, on level feet; the ground under them is not known yet.
  void raise() {
    if (std::ranges::none_of(ground_m.lane, [](float up_m) { return up_m != 0; })) return;
    const auto by_ground = [this](Lanes<float>& up_m) {
      for (std::size_t l = 0; l < lane_count; ++l)
        if (ground_m[l] != 0) up_m[l] += ground_m[l];
    };
    for (auto& joint : pose.position_m) by_ground(joint.y);
    for (auto* const points : {&feet.heel_m, &feet.toe_m, &feet.tip_m})
      for (auto& point : *points) by_ground(point.y);
    by_ground(centre.position_m.y);
  }
};

/// One lane as rows.
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
    return {part_value(size),   part_value(physique),
            part_value(gait),   part_value(plan),
            part_value(state),  part_value(pose),
            part_value(angles), part_value(feet),
            part_value(centre), part_value(Publishes<PublishedLeg>{})};
  }
};

}  // namespace

struct WakingWork::Blocks {
  static constexpr std::size_t most = 64;  // blocks in a batch
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
  ScratchPool room{std::pmr::new_delete_resource()};

  void set(std::size_t b, const WakingBlock& block, Woken as) {
    size[b] = block.walkers.size;
    physique[b] = block.physique;
    gait[b] = block.walkers.gait;
    plan[b] = block.walkers.plan;
    state[b] = block.walkers.state;
    if (as == Woken::compact) return;
    pose[b] = block.pose;
    angles[b] = block.angles;
    feet[b] = block.feet;
    centre[b] = block.centre;
  }
  /// Computes rows of `count` walkers. Calls `put(block, i, lane)` for each, and fills a block's remaining lanes with
  /// its first walker.
  template <class Put>
  void fill(const Jobs& jobs, std::size_t count, Woken as, float tick_s, const Put& put) {
    static_assert(std::is_trivially_destructible_v<WakingBlock> && sizeof(WakingBlock) % sizeof(float) == 0);
    room.prepare(sizeof(WakingBlock) / sizeof(float), jobs.threads);
    in_parallel(jobs, (count + lane_count - 1) / lane_count, [&](std::size_t begin, std::size_t end) {
      const ScratchLease lease(&room);
      auto& block = *new (lease.data()) WakingBlock;
      for (std::size_t b = begin; b < end; ++b) {
        check_interrupt();
        for (std::size_t l = 0; l < lane_count; ++l) {
          const std::size_t i = b * lane_count + l;
          put(block, i < count ? i : b * lane_count, l);
        }
        block.make(tick_s, as);
        set(b, block, as);
      }
    });
  }
  void list_parts(std::span<const ComponentId> more, Woken as) {
    parts = {{component_id<BodySize>(), size.data()},
             {component_id<Physique>(), physique.data()},
             {component_id<Gait>(), gait.data()},
             {component_id<StepPlan>(), plan.data()},
             {component_id<GaitState>(), state.data()}};
    if (as == Woken::full_detail)
      parts.insert(parts.end(), {{component_id<Pose>(), pose.data()},
                                 {component_id<JointAngles>(), angles.data()},
                                 {component_id<Feet>(), feet.data()},
                                 {component_id<CentreOfMass>(), centre.data()},
                                 part_value(Publishes<PublishedLeg>{})});
    for (const ComponentId& part : more) parts.push_back({part, nullptr});
  }
};
WakingWork::WakingWork() = default;
WakingWork::~WakingWork() = default;

void wake_walkers(World& world, const Jobs& jobs, std::span<const Entity> people, Woken as, const SleepTime& time,
                  std::span<const ComponentId> more, std::span<const std::uint64_t> owned, WakingWork& work) {
  if (work.blocks == nullptr) work.blocks = std::make_unique<WakingWork::Blocks>();
  WakingWork::Blocks& blocks = *work.blocks;
  blocks.list_parts(more, as);
  blocks.people.assign(people.begin(), people.end());
  const auto table = [&](Entity person) { return world.locate(person)->table; };
  const auto order = [&](Entity person) { return std::pair(table(person), person.index); };
  std::ranges::sort(blocks.people, {}, order);  // a stable sort would allocate memory
  for (std::span<const Entity> left = blocks.people; !left.empty();) {
    std::size_t count = 1;
    while (count < std::min(left.size(), WakingWork::Blocks::most * lane_count) && table(left[count]) == table(left[0]))
      ++count;
    const auto some = left.first(count);
    left = left.subspan(count);
    blocks.fill(jobs, count, as, time.tick_s,
                [&](WakingBlock& block, std::size_t i, std::size_t lane) { block.put(world, some[i], time, lane); });
    world.change_archetype(some, blocks.parts, owned, jobs);
  }
}

void create_steady(World& to, const Jobs& jobs, std::span<const Sleeper> walkers, const SleepTime& then,
                   std::span<Entity> entities, WakingWork& work) {
  if (work.blocks == nullptr) work.blocks = std::make_unique<WakingWork::Blocks>();
  WakingWork::Blocks& blocks = *work.blocks;
  blocks.list_parts({}, Woken::full_detail);
  while (!walkers.empty()) {
    const auto some = walkers.first(std::min(walkers.size(), WakingWork::Blocks::most * lane_count));
    blocks.fill(jobs, some.size(), Woken::full_detail, then.tick_s,
                [&](WakingBlock& block, std::size_t i, std::size_t lane) {
                  block.put(some[i].asleep, some[i].own_style.style, std::nullopt, then, lane);
                });
    to.create_many(blocks.parts, entities.first(some.size()), jobs);
    entities = entities.subspan(some.size());
    walkers = walkers.subspan(some.size());
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
  block->make(time.tick_s, Woken::full_detail);
  const WokenRow woken(*block, 0);
  for (const PartValue& value : woken.parts()) {
    if (value.part.id != part || value.row == nullptr) continue;
    std::memcpy(row, value.row, 4 * static_cast<std::size_t>(value.part.value));
    return Status::ok;
  }
  return Status::missing;
}

Placing way_of_sleeper(const World& world, const SleepTime& time, const PlaceRequest& to) {
  GaitState<float> state;
  read_asleep(world, to.person, time, type_id<GaitState<float>>(), &state);
  return {state.line_x_m, state.line_z_m, state.heading_rad, to.x_m, to.z_m, to.heading_rad};
}

void place_sleeper(World& world, Entity person, const SleepTime& time, const Placing& way) {
  const double s = exact::sin(double{way.turn_rad()}), c = exact::cos(double{way.turn_rad()});
  const auto go = [&](SteadyWalk<float>& walk, std::uint32_t at_tick) {
    Lanes<std::uint32_t> tick;
    for (auto& lane : tick.lane) lane = at_tick;
    GaitState<Lanes<float>> block;
    steady_state(broadcast(walk), tick, time.tick_s, block);
    const GaitState<float> state = first_lane(block);
    const double x = double{state.line_x_m} - double{way.from_x_m}, z = double{state.line_z_m} - double{way.from_z_m};
    walk.anchor_x_m = static_cast<float>(double{way.to_x_m} + x * c + z * s);
    walk.anchor_z_m = static_cast<float>(double{way.to_z_m} - x * s + z * c);
    walk.anchor_steps = state.steps;
    walk.heading_rad = way.turned(walk.heading_rad);
    walk.asked_heading_rad = way.turned(walk.asked_heading_rad);
  };
  Asleep<float> asleep = *world.get<Asleep>(person);
  const auto since = unsettled_of(world, person);
  if (!is_unsettled(since, time)) {
    go(asleep.walk, time.tick);
  } else {
    Unsettled<float> changing = *since;
    go(changing.before, changing.asked_tick);
    world.set(person, changing);
    if (since->until_tick == 0) {  // the next tick computes the walk from `before` and the request
      asleep.walk.asked_heading_rad = way.turned(asleep.walk.asked_heading_rad);
    } else {
      go(asleep.walk, since->until_tick == never_settles ? time.tick : since->until_tick);
    }
  }
  world.set(person, asleep);
}

}  // namespace mobil::inline v0_3
