#include "systems/states/person_states.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

#include <mobil/components/lod.h>
#include <mobil/systems/people/step_log.h>
#include <mobil/systems/states/lod_state.h>
#include "systems/people/compact_pose.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/ground_forces.h"
#include "systems/people/group_by_table.h"
#include "systems/people/person_requests.h"
#include "systems/states/warm_muscles.h"

namespace mobil::inline v0_3 {
namespace {

/// Brings muscles that have just started to within `within_m` of where they would be.
void warm(const Frame& frame, std::span<const Entity> people, const LegMuscles& choice, float within_m) {
  const MuscleScene scene = scene_of(frame);
  const std::uint32_t ticks = warm_ticks(within_m, scene.time.tick_s);
  if (ticks == 0) return;
  auto& room = frame.workspace.get<SleepWork>().warming;
  if (room == nullptr)
    room = std::make_unique<WarmingRoom>(frame.workspace.get<MuscleMeans>().modules, frame.workspace.memory());
  room->warm(scene, people, choice, ticks);
}

/// Starts muscles kept on the row of an awake person who is not compact (kept_choice).
Result<void> begin_kept(const Frame& frame, Entity person) {
  const auto choice = kept_choice(frame.world, person);
  if (!choice) return {};
  if (auto done = begin_leg_muscles(scene_of(frame), {&person, 1}, *choice); !done) return done;
  frame.world.change_archetype({&person, 1}, {}, std::array{type_id<LegMuscles>()}, frame.jobs);
  choose_from_now(frame.world, person);
  return {};
}

}  // namespace

SleepTime time_of(const Frame& frame) {
  return {frame.tick.index, frame.tick.dt_s};
}

MuscleScene scene_of(const Frame& frame) {
  const auto& means = frame.workspace.get<MuscleMeans>();
  return {frame.world, *means.library, frame.workspace.get<MuscleWork>(), frame.jobs, {frame.tick.index, means.tick_s}};
}

Result<void> wake(const Frame& frame, std::span<const Entity> people, float within_m) {
  World& world = frame.world;
  auto& work = frame.workspace.get<SleepWork>();
  World::Transaction transaction(world, frame.jobs);
  work.asleep.clear();
  work.managed.clear();
  for (const Entity one : people)
    if (is_asleep(world, one)) (world.has<SleepsManaged>(one) ? work.managed : work.asleep).push_back(one);
  drop_repeated(work.asleep);
  drop_repeated(work.managed);
  if (!work.managed.empty()) {
    if (auto done = wake_managed(frame, work.managed, Woken::full_detail); !done) return done;
  }
  const auto warm_them = [&](std::span<const Entity> some, const LegMuscles& choice) {
    warm(frame, some, choice, within_m);
  };
  auto done = wake_people(scene_of(frame), work.asleep, {}, {}, work.owned, work, std::cref(warm_them));
  if (done) transaction.commit();
  return done;
}

Result<void> wake_managed(const Frame& frame, std::span<const Entity> people, Woken as) {
  auto& work = frame.workspace.get<SleepWork>();
  auto done = wake_people(scene_of(frame), people, {WakingMuscles::later, as}, managed_parts(), work.owned, work);
  LodState<float> unseen{};
  unseen.view = static_cast<std::uint32_t>(View::out_of_reach);
  for (const Entity person : people) frame.world.set(person, unseen);
  return done;
}

std::size_t sleep_managed(const Frame& frame, std::span<const Entity> people, std::span<const ComponentId> keeps) {
  auto& work = frame.workspace.get<SleepWork>();
  return *sleep_people(scene_of(frame), people, true, keeps, work.owned, work);
}

Result<std::size_t> set_state(const Frame& frame, std::span<const Entity> people, PersonState state, float within_m) {
  auto& work = frame.workspace.get<SleepWork>();
  Result<void> done;
  if (state == PersonState::posed)
    return fail("nobody becomes posed; spawn_posed makes people whose host animates the skeleton");
  if (state == PersonState::compact) compact(frame, people);
  if (state == PersonState::full) done = make_full(frame, people, within_m);
  if (state == PersonState::asleep) {
    const auto first = [&] { return expand(frame, people); };
    done = sleep_people(scene_of(frame), people, false, {}, work.owned, work, first).map([](std::size_t) {});
  }
  return done.map([&] {
    const auto is_so = [&](Entity person) { return person_state(frame.world, person) == state; };
    return static_cast<std::size_t>(std::ranges::count_if(people, is_so));
  });
}

Result<void> enable(const Frame& frame, std::span<const Entity> people, Feature feature, bool on) {
  World& world = frame.world;
  if (feature == Feature::step_events) {
    const Status status = enable_step_events(world, frame.jobs, people, on);
    if (status == Status::missing) return fail("the host animates one of these people; watch walkers alone", status);
    return result_of("step events", status);
  }
  if (feature == Feature::fat) return result_of("fat", set_fat_wobble(world, frame.jobs, people, on));
  if (feature != Feature::forces) return fail("there is no such feature; take one of Feature's");
  std::vector<Entity> changes;
  for (const Entity person : people) {
    if (!is_person(world, person)) return fail("a person is not there (a stale handle)", Status::stale_entity);
    if (has_forces(world, person) != on) changes.push_back(person);
  }
  World::Transaction transaction(world, frame.jobs);
  if (auto done = make_full(frame, changes); !done) return done;
  auto done = result_of("forces", set_forces(world, frame.jobs, changes, on));
  if (done) transaction.commit();
  return done;
}

std::size_t compact(const Frame& frame, std::span<const Entity> people) {
  return compact_people(scene_of(frame), people, frame.workspace.get<CompactWork>());
}

Result<void> expand(const Frame& frame, std::span<const Entity> people) {
  World::Transaction transaction(frame.world, frame.jobs);
  auto done = expand_people(scene_of(frame), people, frame.workspace.get<CompactWork>());
  if (done) transaction.commit();
  return done;
}

Result<void> make_full(const Frame& frame, std::span<const Entity> people, float within_m) {
  World::Transaction transaction(frame.world, frame.jobs);
  if (auto done = wake(frame, people, within_m); !done) return done;
  std::vector<Entity>& compact = frame.workspace.get<SleepWork>().rows;
  compact.clear();
  for (const Entity person : people)
    if (is_compact(frame.world, person)) compact.push_back(person);
  if (!compact.empty()) {
    drop_repeated(compact);
    if (auto done = expand(frame, compact); !done) return done;
  }
  transaction.commit();
  return {};
}

Result<void> make_muscles_full(const Frame& frame, std::span<const Entity> people) {
  World::Transaction transaction(frame.world, frame.jobs);
  if (auto done = make_full(frame, people); !done) return done;
  for (const Entity person : people) {
    if (auto done = begin_kept(frame, person); !done) return done;
  }
  transaction.commit();
  return {};
}

Result<void> begin_muscles(const Frame& frame, std::span<const Entity> people, const LegMuscles& choice,
                           float within_m) {
  return begin_leg_muscles(scene_of(frame), people, choice).map([&] { warm(frame, people, choice, within_m); });
}

void choose_from_now(World& world, Entity person) {
  if (world.has<LodState>(person)) world.set(person, lod_state_of(world, person));
}

Result<std::size_t> change_walks(const Frame& frame, std::span<const WalkChange> changes) {
  auto& work = frame.workspace.get<SleepWork>();
  std::vector<Entity>& people = work.rows;
  people.clear();
  for (const WalkChange& change : changes) people.push_back(change.person);
  if (!frame.world.alive_once(people))
    return fail("change_gait: a person is not there (a stale handle), or is named twice; name each once",
                Status::stale_entity);
  find_asked(frame.world, frame.jobs, changes, time_of(frame), work, people);
  if (!people.empty()) {
    if (auto done = wake(frame, std::vector(people)); !done) return tl::unexpected(done.error());
  }
  return ask_walks(frame.world, frame.jobs, changes, time_of(frame), work);
}

void place_people(World& world, const SleepTime& time, std::span<const PlaceRequest> places,
                  std::vector<Placing>& ways) {
  ways.clear();
  for (const PlaceRequest& to : places)
    ways.push_back(is_asleep(world, to.person) ? way_of_sleeper(world, time, to) : Placing{});
  for (std::size_t i = 0; i < places.size(); ++i) {  // allocates no memory from here on
    const Entity person = places[i].person;
    if (is_asleep(world, person)) {
      place_sleeper(world, person, time, ways[i]);
    } else {
      move_muscles(world, person, place_walker(world, places[i]));
    }
  }
}

Phase settled_walkers() {
  return {"settled walkers", [](const Frame& frame) {
            auto& work = frame.workspace.get<SleepWork>();
            work.restless.clear();
            end_unsettled(frame.world, frame.jobs, time_of(frame), work.unsettled, work.rows, work.restless);
            if (!work.restless.empty()) wake(frame, std::vector(work.restless));
          }};
}

}  // namespace mobil::inline v0_3
