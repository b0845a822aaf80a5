#pragma once
// States of people and changes between them, including their muscles and their state of level of detail.

#include <cstddef>
#include <span>

#include <mobil/engine/phase.h>
#include <mobil/systems/people/people.h>
#include "systems/states/compact.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {

/// Returns the simulation as the context of changes of muscles. MuscleMeans must be in the workspace.
MuscleScene scene_of(const Frame& frame);

/// Returns the number of ticks that have run, and their length.
SleepTime time_of(const Frame& frame);

/// Wakes sleepers, with muscles within `within_m` of where they would be (Simulation::set_state). People are alive and
/// named once each; those awake are skipped. Wakes all or none.
Result<void> wake(const Frame& frame, std::span<const Entity> people, float within_m = 0.005F);
/// Wakes managed sleepers, named once each, without muscles; level of detail chooses those later.
Result<void> wake_managed(const Frame& frame, std::span<const Entity> people, Woken as);
/// Puts people, named once each, to sleep where possible, managed by level of detail. They keep only `keeps` of the
/// library's components. Returns the number of new sleepers.
std::size_t sleep_managed(const Frame& frame, std::span<const Entity> people, std::span<const ComponentId> keeps);
/// Implement Simulation::set_state and enable. People are alive and named once each. Messages lack these names.
Result<std::size_t> set_state(const Frame& frame, std::span<const Entity> people, PersonState state, float within_m);
Result<void> enable(const Frame& frame, std::span<const Entity> people, Feature feature, bool on);
/// Make walkers compact where possible (returns how many are), and full again. Each is alive and named once.
std::size_t compact(const Frame& frame, std::span<const Entity> people);
Result<void> expand(const Frame& frame, std::span<const Entity> people);
/// Makes sleepers and compact people full, all or none. People are alive; a person can be named twice.
Result<void> make_full(const Frame& frame, std::span<const Entity> people, float within_m = 0.005F);
/// Makes people full as make_full, and starts the muscles that are kept for later.
Result<void> make_muscles_full(const Frame& frame, std::span<const Entity> people);

/// Starts the chosen muscles, within `within_m` of where they would be (Simulation::set_state). People must be awake,
/// not compact, and without muscles.
Result<void> begin_muscles(const Frame& frame, std::span<const Entity> people, const LegMuscles& choice,
                           float within_m);
/// Sets the level-of-detail state of a managed person to the existing muscles.
void choose_from_now(World& world, Entity person);

/// Implements Simulation::change_gait of many people.
Result<std::size_t> change_walks(const Frame& frame, std::span<const WalkChange> changes);

/// Moves walkers, named once each, to other places at once, with their muscles, as if the world had been moved under
/// them. All places are valid (check_place). `ways`: scratch memory.
void place_people(World& world, const SleepTime& time, std::span<const PlaceRequest> places,
                  std::vector<Placing>& ways);

/// Returns the phase after the systems that ends finished changes of sleepers, and wakes those who cannot be steady.
Phase settled_walkers();

}  // namespace mobil::inline v0_3
