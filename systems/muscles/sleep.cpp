#include "systems/muscles/sleep.h"

#include <algorithm>
#include <array>

#include "assets/body/anthropometry.h"
#include "assets/muscles/muscle_plan.h"
#include "engine/row_hash.h"
#include "systems/muscles/choice_words.h"
#include "systems/muscles/muscle_parts.h"
#include "systems/people/ground_forces.h"

namespace mobil {
namespace {

SleepTime sleep_time(const MuscleScene& scene) {
  return {scene.time.tick, static_cast<float>(scene.time.tick_s)};
}

/// Whether all muscles have one method.
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

}  // namespace

std::optional<LegMuscles> sleeper_choice(const World& world, Entity person) {
  const auto* const choice = is_asleep(world, person) ? world.shared<LegMuscles>(person) : nullptr;
  return choice == nullptr ? std::nullopt : std::optional(*choice);
}

std::size_t sleep_people(const MuscleScene& scene, std::span<const Entity> people, bool managed,
                         std::span<const KeyPart> keeps, std::span<const std::uint64_t> owned, SleepWork& work) {
  World& world = scene.world;
  work.sleepers.clear();
  find_steady(world, people, sleep_time(scene), work.sleepers);
  if (!managed) std::erase_if(work.sleepers, [&](const Sleeper& one) { return !have_one_method(world, one.entity); });
  work.rows.clear();
  for (const Sleeper& one : work.sleepers)
    world.each_member(one.entity, [&](Entity member) {
      if (world.has<MuscleOwner>(member)) work.rows.push_back(member);
    });
  std::vector<std::optional<LegMuscles>> choice(work.sleepers.size());
  for (std::size_t i = 0; i < choice.size(); ++i) choice[i] = choice_of(world, work.sleepers[i].entity);
  world.destroy_many(work.rows, scene.jobs);
  scene.work.recent = {};
  for (std::size_t i = 0; i < work.sleepers.size(); ++i) {
    const Sleeper& one = work.sleepers[i];
    std::array<PartValue, 6> more;
    std::size_t count = 0;
    if (choice[i]) {
      const auto kept = scene.library.whole_choice(*choice[i]);
      more[count++] = {key_part(world.share(kept, hash_of(*kept))), nullptr};
    }
    if (has_forces(world, one.entity)) more[count++] = part_value(TagValue<SleepsWithForces>{1});
    for (const KeyPart& part : keeps)
      if (count < more.size()) more[count++] = {part, nullptr};
    put_to_sleep(world, one, std::span(more).first(count), owned);
  }
  return work.sleepers.size();
}

Result<void> wake_people(const MuscleScene& scene, std::span<const Entity> people, std::span<const std::uint64_t> owned,
                         SleepWork& work) {
  World& world = scene.world;
  struct Waking {
    Entity entity;
    std::optional<LegMuscles> choice;
    bool forces;
  };
  std::vector<Waking> waking;
  waking.reserve(people.size());
  for (const Entity person : people)
    waking.push_back({person, sleeper_choice(world, person), world.has<SleepsWithForces>(person)});
  wake_walkers(world, scene.jobs, people, sleep_time(scene), owned, work.waking);
  for (const Waking& one : waking)
    if (one.forces) add_forces(world, one.entity);
  // Each choice together.
  for (std::size_t first = 0; first < waking.size(); ++first) {
    if (!waking[first].choice) continue;
    const LegMuscles choice = *waking[first].choice;
    std::vector<Entity> humans, made;
    std::vector<MuscleSize> size;
    std::vector<Body> bodies;
    for (std::size_t i = first; i < waking.size(); ++i) {
      if (!waking[i].choice || !(*waking[i].choice == choice)) continue;
      waking[i].choice.reset();
      humans.push_back(waking[i].entity);
    }
    const std::size_t each = choice.muscles.count();
    size.resize(humans.size() * each);
    in_parallel(scene.jobs, humans.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t h = begin; h < end; ++h) {
        const Body body = *make_body(body_request(world, humans[h]));
        auto at = size.begin() + static_cast<std::ptrdiff_t>(h * each);
        for (std::size_t m = 0; m < choice.muscles.size(); ++m)
          if (choice.muscles[m]) *at++ = size_of(*make_muscle_plan(body, static_cast<Muscle>(m)));
      }
    });
    made.reserve(2 * size.size());
    auto begun = begin_muscles(world, scene.library, choice, scene.time, scene.jobs, humans, size, made);
    if (!begun) {
      world.undo_create(made);
      return tl::unexpected(begun.error().error);
    }
    for (const Entity human : humans)
      if (follows_moments(choice)) set_leg_moments(world, human, *make_body(body_request(world, human)), choice);
  }
  return {};
}

}  // namespace mobil
