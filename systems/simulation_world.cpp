#include "systems/simulation_world.h"

#include <array>
#include <vector>

#include <mobil/components/relevance.h>
#include <mobil/systems/relevance/relevance_module.h>
#include "systems/muscles/compact.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/sleep.h"
#include "systems/people/by_table.h"
#include "systems/people/ground_forces.h"
#include "systems/simulation_waking.h"

namespace mobil::inline v0_3 {

/// What no sleeper can do wakes them first, and so with who is compact. All of them, or nobody.
Result<void> Simulation::make_whole(std::span<const Entity> people) {
  std::vector<Entity> asleep, compact;
  for (const Entity human : people)
    if (is_asleep(human))
      asleep.push_back(human);
    else if (is_compact(human))
      compact.push_back(human);
  drop_repeated(asleep);
  drop_repeated(compact);
  World::Attempt attempt(*world_, jobs_);
  if (!asleep.empty()) {
    if (auto done = wake(asleep); !done) return done;
  }
  if (!compact.empty()) {
    if (auto done = expand(compact); !done) return done;
  }
  attempt.keep();
  return {};
}

Result<void> Simulation::make_whole_for(Entity human) {
  return make_whole({&human, 1});
}

/// Besides, muscles that somebody is to have later, once Relevance looks at them, begin.
Result<void> Simulation::make_muscles_whole(std::span<const Entity> people) {
  World::Attempt attempt(*world_, jobs_);
  if (auto done = make_whole(people); !done) return done;
  for (const Entity human : people) {
    if (auto done = SimulationWorld::begin_kept(*this, human); !done) return done;
  }
  attempt.keep();
  return {};
}

Result<void> Simulation::set_forces(std::span<const Entity> people, bool on) {
  if (!world_->alive_once(people)) return fail(Status::stale_entity);
  std::vector<Entity> changes;
  for (const Entity human : people) {
    if (!is_person(human)) return fail(Status::stale_entity);
    if (has_forces(*world_, human) != on) changes.push_back(human);
  }
  World::Attempt attempt(*world_, jobs_);
  if (auto done = make_whole(changes); !done) return done;
  auto done = result_of(on ? "add_forces" : "remove_forces", mobil::set_forces(*world_, jobs_, changes, on));
  if (done) attempt.keep();
  return done;
}

Result<void> Simulation::add_forces(Entity human) {
  return set_forces({&human, 1}, true);
}

Result<void> Simulation::remove_forces(Entity human) {
  if (is_person(human) && !has_forces(*world_, human)) return result_of("remove_forces", Status::missing);
  return set_forces({&human, 1}, false);
}

std::size_t SimulationWorld::sleep(Simulation& simulation, std::span<const Entity> people,
                                   std::span<const KeyPart> keeps) {
  auto& work = simulation.workspace_->get<SleepWork>();
  return *sleep_people(simulation.muscle_scene(), people, true, keeps, work.owned, work);
}

Result<void> SimulationWorld::wake(Simulation& simulation, std::span<const Entity> people, Woken as) {
  return wake_managed(simulation.muscle_scene(), simulation.workspace_->get<SleepWork>(), people, as);
}

void SimulationWorld::choose_from_now(Simulation& simulation, Entity human) {
  World& world = *simulation.world_;
  if (world.has<Tiers>(human)) world.set(human, tiers_of(world, human));
}

Result<void> SimulationWorld::begin_kept(Simulation& simulation, Entity human) {
  World& world = *simulation.world_;
  const auto choice = kept_choice(world, human);
  if (!choice) return {};
  if (auto done = begin_leg_muscles(simulation.muscle_scene(), {&human, 1}, *choice); !done) return done;
  world.remake_many({&human, 1}, {}, std::array{type_id<LegMuscles>()}, simulation.jobs_);
  choose_from_now(simulation, human);
  return {};
}

std::size_t SimulationWorld::compact(Simulation& simulation, std::span<const Entity> people) {
  return compact_people(simulation.muscle_scene(), people, simulation.workspace_->get<CompactWork>());
}

Result<void> SimulationWorld::expand(Simulation& simulation, std::span<const Entity> people) {
  return expand_people(simulation.muscle_scene(), people, simulation.workspace_->get<CompactWork>());
}

Result<void> SimulationWorld::begin_muscles(Simulation& simulation, std::span<const Entity> people,
                                            const LegMuscles& choice, float within_m) {
  return begin_leg_muscles(simulation.muscle_scene(), people, choice).map([&] {
    warm_muscles(simulation.muscle_scene(), *simulation.workspace_, people, choice, within_m);
  });
}

}  // namespace mobil::inline v0_3
