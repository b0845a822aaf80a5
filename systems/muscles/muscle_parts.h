#pragma once
// The only list of a muscle's components, used to make, change, check and save muscles. A host's own components on the
// same row are left alone.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "systems/bellies/belly_library.h"
#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

/// Returns the module of lines of action: components of all muscles, and those common to control points and bellies.
Module muscles_module();
/// Returns the module that fades out the difference left by a change of method (mobil/components/fade.h).
Module fade_module();
/// Returns all modules of muscles in data-flow order: these two, effects and methods.
std::vector<Module> muscle_modules();

/// Returns the kind that a muscle of a choice becomes. `world` becomes a co-owner of the kind's resources.
MuscleKind kind_of(World& world, BellyLibrary& library, Muscle muscle, const LegMuscles& choice,
                   const SharedBelly& belly);
/// Returns the components of a muscle of that kind, unsorted.
std::vector<ComponentId> muscle_parts(const MuscleKind& kind);
/// Returns the kind of a muscle with these components; nothing if they are not a muscle's or do not fit each other.
/// Resources are those of `world`.
std::optional<MuscleKind> muscle_kind(const Archetype& key, const World& world);
/// Returns the kind of an entity; nothing for a stale handle or an entity that is not a muscle.
std::optional<MuscleKind> muscle_kind(const World& world, Entity muscle);
/// Returns the method of a muscle; Method::none for a stale handle or an entity that is not a muscle.
MuscleMethod muscle_method(const World& world, Entity muscle);
/// Returns the ids, sorted, of the components of all kinds of muscles: those that a change of a muscle sets or removes.
std::span<const std::uint64_t> muscle_part_ids();

}  // namespace mobil::inline v0_3
