// Leg muscles of a simulation: they come, change and go.
#include "systems/simulation_muscles.h"

#include <utility>

#include "systems/simulation.h"
#include "systems/simulation_change.h"

namespace mobil {

/// Muscles that are there keep their handles, others begin; those that are no longer asked for go.
void Simulation::set_muscles(Human& human, const std::vector<Belly>& bellies, const LegMuscles& choice) {
  std::vector<HumanMuscle> all;
  for (const Belly& belly : bellies) {
    HumanMuscle own{belly.plan, {}, {choice.method, choice.reduced}};
    for (HumanMuscle& before : human.muscles) {
      if (before.plan.muscle == belly.plan.muscle) std::swap(own.entity, before.entity);
    }
    for (const Side side : {right, left}) {
      make_muscle(world_, *work_, {human, side, belly, choice, false, tick_, static_cast<float>(clock_.tick_s())},
                  own.entity[side]);
    }
    all.push_back(own);
  }
  for (const HumanMuscle& before : human.muscles) {
    for (const Entity muscle : before.entity) world_.destroy(muscle);
  }
  human.muscles = std::move(all);
  human.leg_muscles = choice;
}

Result<void> Simulation::add_leg_muscles(Entity entity, const LegMuscles& choice) {
  Human* human = find(entity);
  if (human == nullptr) return fail("add_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (!human->muscles.empty()) return fail("add_leg_muscles: this person has leg muscles; remove them first");
  const auto bellies = bellies_.bellies(human->body, choice, clock_.tick_s());
  if (!bellies) return fail("add_leg_muscles: " + bellies.error().message);
  set_muscles(*human, *bellies, choice);
  return {};
}

Result<void> Simulation::change_leg_muscles(Entity entity, const LegMuscles& choice) {
  Human* human = find(entity);
  if (human == nullptr) return fail("change_leg_muscles: that person is not there (a stale handle); spawn one first");
  if (human->muscles.empty()) return fail("change_leg_muscles: this person has no leg muscles; add them first");
  const auto bellies = bellies_.bellies(human->body, choice, clock_.tick_s());
  if (!bellies) return fail("change_leg_muscles: " + bellies.error().message);
  set_muscles(*human, *bellies, choice);
  return {};
}

Status Simulation::remove_leg_muscles(Entity entity) {
  Human* human = find(entity);
  if (human == nullptr) return Status::stale_entity;
  for (const HumanMuscle& own : human->muscles) {
    for (const Entity muscle : own.entity) world_.destroy(muscle);
  }
  human->muscles.clear();
  human->leg_muscles = {};
  return Status::ok;
}

}  // namespace mobil
