// Many people at once.
#include <fmt/format.h>

#include "assets/anthropometry.h"
#include "systems/simulation.h"
#include "systems/simulation_change.h"

namespace mobil {

Result<void> Simulation::spawn(std::span<const SpawnRequest> people, std::span<Entity> entities) {
  if (people.size() != entities.size()) {
    return fail(
        fmt::format("spawn: {} people, and room for the handles of {}; give as many", people.size(), entities.size()));
  }
  for (std::size_t i = 0; i < people.size(); ++i) {
    auto made = spawn_one(people[i]);
    Result<void> done{};
    if (!made) {
      done = tl::unexpected(made.error());
    } else {
      entities[i] = *made;
      if (people[i].muscles) done = add_leg_muscles(*made, *people[i].muscles);
    }
    if (done) continue;
    for (std::size_t j = 0; j < i; ++j) despawn(entities[j]);
    if (made) despawn(*made);
    return fail(fmt::format("spawn: person {}: {}", i, done.error().message));
  }
  return {};
}

Status Simulation::despawn(std::span<const Entity> people) {
  for (const Entity entity : people) {
    if (person(entity) == nullptr) return Status::stale_entity;
  }
  for (const Entity entity : people) despawn(entity);
  return Status::ok;
}

Result<void> Simulation::prepare(const LegMuscles& choice) {
  const auto made = bellies_.bellies(*make_body({}), choice, tick_s());
  if (!made) return fail("prepare: " + made.error().message);
  return {};
}

}  // namespace mobil
