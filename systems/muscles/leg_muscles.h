#pragma once
// A person's leg muscles: spawning, adding, changing and removing. Each muscle is an entity that belongs to its person
// (World::each_member) and has the choice that it was made with.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <mobil/components/leg_muscles.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include <mobil/systems/people/sleepers.h>
#include "systems/bellies/belly_library.h"
#include "systems/muscles/change_muscles.h"
#include "systems/people/person_requests.h"
#include "systems/people/spawn.h"

namespace mobil::inline v0_3 {

/// Resources for changes of muscles throughout a simulation: templates and bases, the length of a tick, and the modules
/// that simulate new muscles' past (WarmingRoom).
struct MuscleMeans {
  std::shared_ptr<BellyLibrary> library;
  double tick_s = 0;
  std::span<const Module> modules{};  // the library's own
};

/// Context of functions that make and change muscles.
struct MuscleScene {
  World& world;
  BellyLibrary& library;
  MuscleWork& work;
  const Jobs& jobs;
  MuscleTime time;
};

/// Returns a person's muscles in the table's order; empty for a stale handle. A side that is gone has a stale handle.
std::vector<MuscleRef> muscles_of(const World& world, Entity person);
/// Returns true if the person has muscles. Allocates no memory.
bool has_muscles(const World& world, Entity person);
/// Returns a person's muscle of that side, or a stale handle if the person does not have it.
Entity muscle_of(const World& world, Entity person, Muscle muscle, Side side);
/// Returns the choice of a person's muscles: their tissue and effects, and the method of the first one. Returns nothing
/// without muscles.
std::optional<LegMuscles> choice_of(const World& world, Entity person);

/// Returns a choice with muscles and method, for the row of a person who has no muscles for a while. Equal choices give
/// the same handle.
Shared<LegMuscles> keep_choice(World& world, BellyLibrary& library, const LegMuscles& choice);

/// Spawns all people with muscles, or none; `entities` is as long as `people`. Errors name the first invalid person.
tl::expected<void, NotMade> spawn_people(const MuscleScene& scene, std::span<const SpawnRequest> people,
                                         std::span<Entity> entities);
/// Removes people and all that belongs to them. Removes none if a handle is stale or named twice: Status::stale_entity.
Status despawn_people(World& world, const Jobs& jobs, std::span<const Entity> people);

/// Creates the muscles of a valid choice for people who exist and have none, at rest in the current pose. Errors: those
/// of add_leg_muscles. After an error, or if memory runs out, no person has new muscles.
Result<void> begin_leg_muscles(const MuscleScene& scene, std::span<const Entity> people, const LegMuscles& choice);

/// Implement the functions of Simulation with similar names (mobil/simulation.h). Messages lack the function's name.
Result<void> add_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice);
/// Returns the error with which these muscles would be refused to a person, awake or not, if there is one.
Result<void> check_leg_muscles(const World& world, BellyLibrary& library, double tick_s, Entity person,
                               const LegMuscles& choice);
Result<void> change_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice);
Status remove_leg_muscles(World& world, const Jobs& jobs, Entity person);
Result<void> check_excitation(const World& world, Entity person, Muscle muscle, Side side, float excitation);
Result<void> set_excitation(World& world, Entity person, Muscle muscle, Side side, float excitation);
Result<void> set_method(const MuscleScene& scene, Entity person, Muscle muscle, const MuscleMethod& method);

/// Moves a person's muscles and their stored past positions rigidly from the old place to the new one.
void move_muscles(World& world, Entity person, const Placing& way);
/// Clears the past motion of a person's muscle frames, so that a jump causes no inertial load.
void forget_motion(World& world, Entity person);
/// Subtracts (x, 0, z) from the positions of all muscles and from their stored past positions.
void shift_muscles(World& world, float x_m, float z_m);

/// Removes finished fades from their rows. Runs after a tick.
void end_fades(World& world, float tick_s, MuscleWork& work);

}  // namespace mobil::inline v0_3
