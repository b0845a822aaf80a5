// Leg muscles of a simulation: they come, change and go.
#include "systems/simulation_muscles.h"

#include <utility>

#include "assets/anthropometry.h"
#include "systems/simulation.h"
#include "systems/simulation_change.h"

namespace mobil {

/// Muscles that are there keep their handles, others begin; those that are no longer asked for go.
void Simulation::set_muscles(PersonRecord& person, const std::vector<Belly>& bellies, const LegMuscles& choice) {
  std::vector<OwnMuscle> all;
  all.reserve(bellies.size());
  for (const Belly& belly : bellies) {
    OwnMuscle own{belly.plan.muscle, {}, {choice.method, choice.reduced}};
    for (OwnMuscle& before : person.muscles) {
      if (before.muscle == own.muscle) std::swap(own.entity, before.entity);
    }
    for (const Side side : {right, left}) {
      make_muscle(world_, *work_, {person.entity, side, belly, choice, false, tick_, static_cast<float>(tick_s())},
                  own.entity[side]);
    }
    all.push_back(own);
  }
  for (const OwnMuscle& before : person.muscles) {
    for (const Entity muscle : before.entity) world_.destroy(muscle);
  }
  person.muscles = std::move(all);
  person.choice = people_.number_of(choice);
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
  std::vector<Entity> rows;
  for (const OwnMuscle& own : human->muscles) {
    for (const Entity muscle : own.entity) {
      if (world_.alive(muscle)) rows.push_back(muscle);
    }
  }
  world_.destroy_many(rows, jobs_);
  human->muscles.clear();
  return Status::ok;
}

}  // namespace mobil
