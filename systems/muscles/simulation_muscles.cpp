// Leg muscles of a simulation: they come, change and go.
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "assets/body/anthropometry.h"
#include "systems/muscles/change_muscles.h"
#include "systems/people/simulation_batch.h"
#include "systems/simulation.h"

namespace mobil {

Result<void> Simulation::change_leg_muscles(Entity entity, const LegMuscles& choice) {
  PersonRecord* human = find(entity);
  if (human == nullptr) return fail("change_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (human->muscles.empty()) return fail("change_leg_muscles: this person has no leg muscles; add them first");
  if (auto done = set_muscles(*human, choice); !done) return fail("change_leg_muscles: " + done.error().message);
  return {};
}

/// Muscles that are there keep their handles, others begin; those that are no longer asked for go.
Result<void> Simulation::set_muscles(PersonRecord& person, const LegMuscles& choice) {
  if (auto ok = check_choice(choice, tick_s()); !ok) return ok;
  const Body body = *make_body(person.body);
  const std::uint32_t number = people_.number_of(choice);
  LegMuscles new_ones = choice;
  std::vector<OwnMuscle> stay;
  std::vector<Belly> bellies;
  std::vector<MuscleSize> size;
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    if (!choice.muscles[m]) continue;
    const auto muscle = static_cast<Muscle>(m);
    const MusclePlan plan = *make_muscle_plan(body, muscle);
    const auto own = std::ranges::find(person.muscles, muscle, &OwnMuscle::muscle);
    if (own == person.muscles.end()) {
      size.push_back(size_of(plan));
      continue;
    }
    new_ones.muscles.reset(m);
    stay.push_back(*own);
    auto belly = bellies_.belly(plan, choice, tick_s());
    if (!belly) return fail(std::string(muscle_name(muscle)) + ": " + belly.error().message);
    bellies.push_back(std::move(*belly));
  }
  Batch batch(*this, 2 * size.size());
  std::vector<OwnMuscle> all(size.size());
  all.reserve(size.size() + stay.size());
  const MuscleTime now{tick_, tick_s()};
  if (auto begun = begin_muscles(world_, bellies_, new_ones, now, jobs_, {&person.entity, 1}, size, all, batch.made);
      !begun) {
    return tl::unexpected(begun.error().error);
  }
  change_muscles(world_, *work_, {person.entity, choice, false, now}, bellies, stay);
  batch.done = true;
  all.insert(all.end(), stay.begin(), stay.end());
  std::ranges::sort(all, {}, &OwnMuscle::muscle);
  for (const OwnMuscle& before : person.muscles) {
    if (choice.muscles[static_cast<std::size_t>(before.muscle)]) continue;
    for (const Entity muscle : before.entity) world_.destroy(muscle);
  }
  person.muscles = std::move(all);
  person.choice = number;
  return {};
}

Status Simulation::remove_leg_muscles(Entity entity) {
  PersonRecord* human = find(entity);
  if (human == nullptr) return Status::stale_entity;
  std::array<Entity, 2 * MuscleSet{}.size()> rows;
  std::size_t count = 0;
  for (const OwnMuscle& own : human->muscles) {
    for (const Entity muscle : own.entity) {
      if (world_.alive(muscle)) rows[count++] = muscle;
    }
  }
  world_.destroy_many(std::span(rows).first(count), jobs_);
  human->muscles.clear();
  return Status::ok;
}

}  // namespace mobil
