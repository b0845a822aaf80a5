#pragma once
// Queries of the facade about a whole simulation, computed on each call.

#include <optional>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>

namespace mobil::inline v0_3 {

/// Implement Simulation::person, people and report.
std::optional<Person> read_person(const Simulation& simulation, Entity entity);
std::vector<Entity> read_people(const World& world);
StepReport read_report(const Schedule& schedule, std::uint32_t ticks);

}  // namespace mobil::inline v0_3
