#pragma once
// A person's leg muscles: they come with people, are added, change and go. Each muscle is an entity that belongs to its
// person (World::each_member) and has the choice that it was made with.

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
#include <mobil/systems/people/person_requests.h>
#include <mobil/systems/people/sleepers.h>
#include <mobil/systems/people/spawn.h>
#include "systems/bellies/belly_library.h"
#include "systems/muscles/change_muscles.h"

namespace mobil::inline v0_3 {

/// What changes of muscles need throughout a simulation: templates and bases, the length of a tick, and what muscles
/// that begin are run ahead by (WarmingRoom).
struct MuscleMeans {
  std::shared_ptr<BellyLibrary> library;
  double tick_s = 0;
  std::span<const Module> modules{};  // the library's own
};

/// What is needed to make and change muscles.
struct MuscleScene {
  World& world;
  BellyLibrary& library;
  MuscleWork& work;
  const Jobs& jobs;
  MuscleTime time;
};

/// A person's muscles in the table's order; empty for a stale handle. A side that is gone has a stale handle.
std::vector<MuscleRef> muscles_of(const World& world, Entity person);
/// Whether there are any. Takes no memory.
bool has_muscles(const World& world, Entity person);
/// A person's muscle of that side; a stale handle where there is none.
Entity muscle_of(const World& world, Entity person, Muscle muscle, Side side);
/// What a person's muscles were chosen as: their tissue and effects, the method of the first one. Nothing without
/// muscles.
std::optional<LegMuscles> choice_of(const World& world, Entity person);

/// A choice with muscles and method, to be kept on the row of a person who has no muscles for a while; equal choices
/// give the same handle.
Shared<LegMuscles> keep_choice(World& world, BellyLibrary& library, const LegMuscles& choice);

/// All people with their muscles, or none; `entities` as long as `people`. Errors name the first person who cannot be.
tl::expected<void, NotMade> spawn_people(const MuscleScene& scene, std::span<const SpawnRequest> people,
                                         std::span<Entity> entities);
/// People and all that belongs to them go. Where one is stale or named twice, Status::stale_entity, and all stay.
Status despawn_people(World& world, const Jobs& jobs, std::span<const Entity> people);

/// The muscles of a choice in range begin on people who are there and have none, at rest where they stand. Errors: as
/// add_leg_muscles; where there is one, or memory runs out, none has any.
Result<void> begin_leg_muscles(const MuscleScene& scene, std::span<const Entity> people, const LegMuscles& choice);

/// As the members of Simulation of these names (mobil/simulation.h); messages without that name.
Result<void> add_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice);
/// Whether a person, awake or not, may have these muscles: whatever they would be refused for.
Result<void> check_leg_muscles(const World& world, BellyLibrary& library, double tick_s, Entity person,
                               const LegMuscles& choice);
Result<void> change_leg_muscles(const MuscleScene& scene, Entity person, const LegMuscles& choice);
Status remove_leg_muscles(World& world, const Jobs& jobs, Entity person);
Result<void> check_excitation(const World& world, Entity person, Muscle muscle, Side side, float excitation);
Result<void> set_excitation(World& world, Entity person, Muscle muscle, Side side, float excitation);
Result<void> set_method(const MuscleScene& scene, Entity person, Muscle muscle, const MuscleMethod& method);

/// Places of a person's muscles, and what they remember of places, go along a way through the world.
void move_muscles(World& world, Entity person, const Placing& way);
/// A person's muscles forget where their frames were, so that no inertia is felt of a jump.
void forget_motion(World& world, Entity person);
/// Places of all muscles, and what they remember of places, less (x, 0, z).
void shift_muscles(World& world, float x_m, float z_m);

/// Fades that are over leave their rows. After a tick.
void end_fades(World& world, float tick_s, MuscleWork& work);

}  // namespace mobil::inline v0_3
