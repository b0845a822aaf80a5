#pragma once
// What the facade reports of a simulation as a whole, put together when it is asked for.

#include <optional>
#include <vector>

#include <mobil/simulation.h>
#include <mobil/step_report.h>
#include <mobil/systems/muscles/person.h>

namespace mobil::inline v0_3 {

/// As Simulation::person, people and report.
std::optional<Person> read_person(const Simulation& simulation, Entity entity);
std::vector<Entity> read_people(const World& world);
StepReport read_report(const Schedule& schedule, std::uint32_t ticks);

}  // namespace mobil::inline v0_3
