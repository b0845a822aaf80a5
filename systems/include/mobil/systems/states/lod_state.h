#pragma once
// State of a person managed by level of detail, and the methods of its levels.

#include <cstddef>
#include <span>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Returns the parts of a managed person, for SpawnRequest::parts.
std::span<const ComponentId> managed_parts();
/// Returns true if level of detail manages a person, awake or asleep.
bool is_managed(const World& world, Entity person);
/// Returns the initial state for a person with the present muscles and methods. Forced methods stay forced.
LodState<float> lod_state_of(const World& world, Entity person);
/// Returns the method of a level for Simulation::set_method, of `active_levels` or of `levels`.
MuscleMethod level_method(std::size_t level, bool control_points, bool active = false);

}  // namespace mobil::inline v0_3
