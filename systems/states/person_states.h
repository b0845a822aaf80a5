#pragma once
// What state people are in, and what brings them from one to another: with their muscles, and with what level of detail
// keeps of them.

#include <cstddef>
#include <span>

#include <mobil/engine/phase.h>
#include <mobil/systems/people/person_state.h>
#include "systems/states/compact.h"
#include "systems/states/sleep.h"

namespace mobil::inline v0_3 {

/// The simulation as the scene that changes of muscles take. MuscleMeans must be in the workspace.
MuscleScene scene_of(const Frame& frame);

/// Ticks that have run, and their length.
SleepTime time_of(const Frame& frame);

/// Sleepers wake, with muscles within `within_m` of where they would be (Simulation::set_state). People are alive and
/// named once each; those awake are left alone. All, or nobody.
Result<void> wake(const Frame& frame, std::span<const Entity> people, float within_m = 0.005F);
/// Managed sleepers wake, named once each, without muscles; level of detail decides about them from then on.
Result<void> wake_managed(const Frame& frame, std::span<const Entity> people, Woken as);
/// People who may do so fall asleep, managed by level of detail, and keep `keeps` of the library's parts. Named once
/// each. Returns how many.
std::size_t sleep_managed(const Frame& frame, std::span<const Entity> people, std::span<const ComponentId> keeps);
/// As Simulation::set_state and enable, people being alive and named once each; messages without these names.
Result<std::size_t> set_state(const Frame& frame, std::span<const Entity> people, PersonState state, float within_m);
Result<void> enable(const Frame& frame, std::span<const Entity> people, Feature feature, bool on);
/// Walkers, alive and named once each, become compact who may (returns how many are), and full again.
std::size_t compact(const Frame& frame, std::span<const Entity> people);
Result<void> expand(const Frame& frame, std::span<const Entity> people);
/// Sleepers wake and compact people are full. Alive; a name may come twice. All, or nobody.
Result<void> make_full(const Frame& frame, std::span<const Entity> people, float within_m = 0.005F);
/// The same, and muscles that somebody is to have later begin.
Result<void> make_muscles_full(const Frame& frame, std::span<const Entity> people);

/// The choices of muscles begin, within `within_m` of where they would be (Simulation::set_state), on people who are
/// awake, whole and without muscles.
Result<void> begin_muscles(const Frame& frame, std::span<const Entity> people, const LegMuscles& choice,
                           float within_m);
/// What level of detail remembers of a managed person becomes that of the muscles that are there.
void choose_from_now(World& world, Entity person);

/// As Simulation::change_gait of many.
Result<std::size_t> change_walks(const Frame& frame, std::span<const WalkChange> changes);

/// Walkers, named once each, are put elsewhere at once, with their muscles, as if the world had been moved under them.
/// All places are good (check_place). `ways`: memory to work in.
void place_people(World& world, const SleepTime& time, std::span<const PlaceRequest> places,
                  std::vector<Placing>& ways);

/// After the systems: sleepers who have finished a change are steady again; those who cannot be steady wake.
Phase settled_walkers();

}  // namespace mobil::inline v0_3
