#include "systems/simulation_world.h"

#include "components/relevance.h"
#include "systems/muscles/compact.h"
#include "systems/muscles/leg_muscles.h"
#include "systems/muscles/sleep.h"
#include "systems/relevance/relevance_module.h"

namespace mobil {

std::size_t SimulationWorld::sleep(Simulation& simulation, std::span<const Entity> people,
                                   std::span<const KeyPart> keeps) {
  return sleep_people(simulation.muscle_scene(), people, true, keeps, simulation.awake_parts_, *simulation.sleep_work_);
}

Result<void> SimulationWorld::wake(Simulation& simulation, std::span<const Entity> people, Woken as) {
  auto done = wake_people(simulation.muscle_scene(), people, {WakingMuscles::later, as}, relevance_parts(),
                          simulation.awake_parts_, *simulation.sleep_work_);
  Tiers<float> unseen{};
  unseen.view = static_cast<std::uint32_t>(View::out_of_reach);
  for (const Entity human : people) simulation.world_->set(human, unseen);
  return done;
}

std::size_t SimulationWorld::compact(Simulation& simulation, std::span<const Entity> people) {
  return compact_people(simulation.muscle_scene(), people, *simulation.compact_work_);
}

Result<void> SimulationWorld::expand(Simulation& simulation, std::span<const Entity> people) {
  return expand_people(simulation.muscle_scene(), people, *simulation.compact_work_);
}

Result<void> SimulationWorld::begin_muscles(Simulation& simulation, std::span<const Entity> people,
                                            const LegMuscles& choice, float within_m) {
  return begin_leg_muscles(simulation.muscle_scene(), people, choice).map([&] {
    simulation.warm_muscles(people, choice, within_m);
  });
}

}  // namespace mobil
