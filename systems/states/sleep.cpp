#include "systems/states/sleep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <mobil/components/compact.h>
#include <mobil/components/fat.h>
#include <mobil/systems/people/step_log.h>
#include "engine/row_hash.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/fat_wobble.h"
#include "systems/people/ground_forces.h"
#include "systems/states/warm_muscles.h"

namespace mobil::inline v0_3 {
namespace {

SleepTime sleep_time(const MuscleScene& scene) {
  return {scene.time.tick, static_cast<float>(scene.time.tick_s)};
}

/// Returns true if all muscles have the same method.
bool have_one_method(const World& world, Entity person) {
  std::optional<MuscleMethod> first;
  bool same = true;
  world.each_member(person, [&](Entity member) {
    if (!world.has<MuscleOwner>(member)) return;
    const MuscleMethod method = muscle_method(world, member);
    if (!first) first = method;
    same = same && same_method(*first, method);
  });
  return same;
}

AskedWalk asked_walk(const World& world, const WalkChange& wanted, const SleepTime& now) {
  const auto& [person, change, heading_rad] = wanted;
  AskedWalk asked{};
  const auto before = asked_body(world, person);
  if (!before) return asked;
  asked.gait = before->gait;
  asked.size = before->size;
  asked.asleep = is_asleep(world, person);
  asked.must_wake = asked.asleep && (is_busy(world, person, now) || (change && change->style));
  if (change) {
    const auto changed = changed_gait(*before, change_on_level(world, person, *change));
    asked.gait = changed ? std::optional(*changed) : std::nullopt;
    asked.walks_otherwise = changed && !same_walk(*changed, before->gait);
  }
  if (!asked.gait || !heading_rad) return asked;
  asked.gait->heading_rad = *heading_rad;
  if (!(std::fabs(*heading_rad) < 1e4F)) asked.gait.reset();
  return asked;
}

}  // namespace

SleepWork::SleepWork() = default;
SleepWork::~SleepWork() = default;

void find_asked(const World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                SleepWork& work, std::vector<Entity>& must_wake) {
  std::vector<AskedWalk>& asked = work.asked;
  asked.resize(changes.size());
  in_parallel(jobs, changes.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) asked[i] = asked_walk(world, changes[i], now);
  });
  work.sizes.clear();
  work.gaits.clear();
  for (const AskedWalk& one : asked) {
    if (!one.gait || !one.walks_otherwise) continue;
    work.sizes.push_back(one.size);
    work.gaits.push_back(*one.gait);
  }
  keep_walk_limits(jobs, work.sizes, work.gaits, work.styles);
  for (std::size_t i = 0, k = 0; i < asked.size(); ++i) {
    if (!asked[i].gait || !asked[i].walks_otherwise) continue;
    const Gait<float>& kept = work.gaits[k++];
    if (asked[i].asleep && !same_style(kept.style, asked[i].gait->style)) asked[i].must_wake = true;
    asked[i].gait = kept;
  }
  must_wake.clear();
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (asked[i].gait && asked[i].must_wake) must_wake.push_back(changes[i].person);
}

std::size_t ask_walks(World& world, const Jobs& jobs, std::span<const WalkChange> changes, const SleepTime& now,
                      SleepWork& work) {
  std::size_t refused = 0;
  work.asked_sleepers.clear();
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const AskedWalk& asked = work.asked[i];
    if (!asked.gait) {
      ++refused;
    } else if (asked.asleep && !asked.must_wake) {
      work.asked_sleepers.push_back({changes[i].person, *asked.gait});
    } else {
      world.set(changes[i].person, *asked.gait);
    }
  }
  ask_sleepers(world, jobs, work.asked_sleepers, now);
  return refused;
}

std::optional<LegMuscles> kept_choice(const World& world, Entity person) {
  const auto* const choice = world.has<MuscleOwner>(person) ? nullptr : world.shared<LegMuscles>(person);
  return choice == nullptr || has_muscles(world, person) ? std::nullopt : std::optional(*choice);
}

bool has_any_muscles(const World& world, Entity person) {
  return world.has<CompactMuscles>(person) || kept_choice(world, person) || has_muscles(world, person);
}

Result<std::size_t> sleep_people(const MuscleScene& scene, std::span<const Entity> people, bool managed,
                                 std::span<const ComponentId> keeps, std::span<const std::uint64_t> owned,
                                 SleepWork& work, const std::function<Result<void>()>& first) {
  World& world = scene.world;
  // Sleepers' rows are made before muscles are destroyed: making them allocates memory, and can be undone.
  World::Transaction transaction(world, scene.jobs);
  if (first) {
    if (auto done = first(); !done) return tl::unexpected(done.error());
  }
  work.sleepers.clear();
  find_steady(world, people, sleep_time(scene), work.sleepers);
  if (!managed) std::erase_if(work.sleepers, [&](const Sleeper& one) { return !have_one_method(world, one.entity); });
  work.rows.clear();
  for (const Sleeper& one : work.sleepers)
    world.each_member(one.entity, [&](Entity member) {
      if (world.has<MuscleOwner>(member)) work.rows.push_back(member);
    });
  // Groups of one table, choice and kind of style.
  work.groups.clear();
  for (const Sleeper& one : work.sleepers) {
    auto choice = choice_of(world, one.entity);
    if (!choice) choice = kept_choice(world, one.entity);
    SleepWork::Group group{&one, world.locate(one.entity)->table, one.style.has_value(), std::nullopt};
    if (choice) group.choice = component_id(keep_choice(world, scene.library, *choice));
    work.groups.push_back(group);
  }
  const auto order = [](const SleepWork::Group& group) {
    return std::tuple(group.table, group.packed, group.choice ? group.choice->value + 1 : 0);
  };
  std::ranges::stable_sort(work.groups, {}, order);
  for (auto group = work.groups.begin(); group != work.groups.end();) {
    const auto end = std::find_if(group, work.groups.end(), [&](const auto& g) { return order(g) != order(*group); });
    std::vector<ComponentId>& more = work.parts;
    more.clear();
    if (group->choice) more.push_back(*group->choice);
    if (has_forces(world, group->sleeper->entity)) more.push_back(component_id(TagValue<SleepsWithForces>{1}));
    if (has_step_events(world, group->sleeper->entity)) more.push_back(component_id(TagValue<SleepsWithStepEvents>{1}));
    if (has_fat(world, group->sleeper->entity)) more.push_back(component_id(TagValue<SleepsWithFat>{1}));
    for (const ComponentId& part : keeps)
      if (!group->choice || part.id != group->choice->id) more.push_back(part);
    work.together.clear();
    for (; group != end; ++group) work.together.push_back(group->sleeper);
    put_to_sleep(world, scene.jobs, work.together, more, owned, work.falling);
  }
  transaction.commit();
  world.destroy_many(work.rows, scene.jobs);
  scene.work.recent = {};
  return work.sleepers.size();
}

Result<void> wake_people(const MuscleScene& scene, std::span<const Entity> people, const Waking& how,
                         std::span<const ComponentId> more, std::span<const std::uint64_t> owned, SleepWork& work,
                         const MusclesBegun& then) {
  World& world = scene.world;
  if (work.all_but_choice.empty()) {
    work.all_but_choice.assign(owned.begin(), owned.end());
    std::erase(work.all_but_choice, type_id<LegMuscles>());
  }
  std::vector<SleepWork::Sleeping>& waking = work.waking_people;
  waking.clear();
  for (const Entity person : people)
    waking.push_back({person, world.shared<LegMuscles>(person), world.has<SleepsWithForces>(person),
                      world.has<SleepsWithStepEvents>(person), world.has<SleepsWithFat>(person)});
  const bool later = how.muscles == WakingMuscles::later;
  for (const auto& [watched, fat] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
    work.alike.clear();
    work.parts.assign(more.begin(), more.end());
    for (const SleepWork::Sleeping& one : waking)
      if (one.watched == watched && one.fat == fat) work.alike.push_back(one.entity);
    if (watched) work.parts.push_back(component_id(Publishes<StepEvents>{}));
    if (fat) work.parts.push_back(component_id<FatWobble>());
    wake_walkers(world, scene.jobs, work.alike, how.as, sleep_time(scene), work.parts,
                 later ? work.all_but_choice : owned, work.waking);
  }
  work.alike.clear();
  for (const SleepWork::Sleeping& one : waking)
    if (one.forces) work.alike.push_back(one.entity);
  set_forces(world, scene.jobs, work.alike, true);
  // One choice at a time.
  std::vector<Entity> alike;
  for (std::size_t first = 0; first < waking.size() && !later; ++first) {
    const LegMuscles* const choice = waking[first].choice;
    if (choice == nullptr) continue;
    alike.clear();
    for (std::size_t i = first; i < waking.size(); ++i) {
      if (waking[i].choice != choice) continue;
      waking[i].choice = nullptr;
      alike.push_back(waking[i].entity);
    }
    if (auto begun = begin_leg_muscles(scene, alike, *choice); !begun) return begun;
    if (then) then(alike, *choice);
  }
  return {};
}

}  // namespace mobil::inline v0_3
