#pragma once
// The one list of what a muscle consists of. Making, changing, checking and saving muscles all read it; parts of a
// host's own on the same row are left alone.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "systems/bellies/belly_library.h"
#include "systems/deformation/method.h"

namespace mobil::inline v0_3 {

/// Lines of action: what every muscle has, and what those with control points or a belly have whatever their method.
Module muscles_module();
/// What a change of method left over (mobil/components/fade.h).
Module fade_module();
/// All of muscles' modules in the order of their data: these two, effects and methods.
std::vector<Module> muscle_modules();

/// The kind that a muscle of a choice becomes; `world` takes a share in what it shares.
MuscleKind kind_of(World& world, BellyLibrary& library, Muscle muscle, const LegMuscles& choice,
                   const SharedBelly& belly);
/// The parts of a muscle of that kind, in no order.
std::vector<ComponentId> muscle_parts(const MuscleKind& kind);
/// The kind of muscle that has these parts; nothing where they are no muscle's or do not fit each other. Resources are
/// those of `world`.
std::optional<MuscleKind> muscle_kind(const Archetype& key, const World& world);
/// The same of an entity; nothing for a stale handle too.
std::optional<MuscleKind> muscle_kind(const World& world, Entity muscle);
/// How a muscle is simulated; Method::none for a stale handle and for what is no muscle.
MuscleMethod muscle_method(const World& world, Entity muscle);
/// Ids of all parts that muscles of whatever kind have, sorted: what a change of a muscle decides.
std::span<const std::uint64_t> muscle_part_ids();

}  // namespace mobil::inline v0_3
