// Leg muscles of a simulation: they come, change and go.
#include "systems/muscles/simulation_muscles.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "assets/body/anthropometry.h"
#include "systems/muscles/simulation_change.h"
#include "systems/simulation.h"

namespace mobil {

/// Muscles that are there keep their handles, others begin; those that are no longer asked for go.
void Simulation::set_muscles(PersonRecord& person, const std::vector<Belly>& bellies, const LegMuscles& choice) {
  const std::uint32_t number = people_.number_of(choice);
  std::vector<OwnMuscle> all;
  all.reserve(bellies.size());
  for (const Belly& belly : bellies) all.push_back({belly.plan.muscle, {}, {choice.method, choice.reduced}});
  const auto among_all = [&](Muscle muscle) {
    return std::find_if(all.begin(), all.end(), [&](const OwnMuscle& own) { return own.muscle == muscle; });
  };
  for (const OwnMuscle& before : person.muscles) {
    if (const auto own = among_all(before.muscle); own != all.end()) own->entity = before.entity;
  }
  make_muscles(world_, *work_, {person.entity, choice, false, tick_, static_cast<float>(tick_s())}, bellies, all);
  for (const OwnMuscle& before : person.muscles) {
    if (among_all(before.muscle) != all.end()) continue;
    for (const Entity muscle : before.entity) world_.destroy(muscle);
  }
  person.muscles = std::move(all);
  person.choice = number;
}

Result<void> Simulation::change_leg_muscles(Entity entity, const LegMuscles& choice) {
  PersonRecord* human = find(entity);
  if (human == nullptr) return fail("change_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (human->muscles.empty()) return fail("change_leg_muscles: this person has no leg muscles; add them first");
  const auto bellies = bellies_.bellies(*make_body(human->body), choice, tick_s());
  if (!bellies) return fail("change_leg_muscles: " + bellies.error().message);
  set_muscles(*human, *bellies, choice);
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
