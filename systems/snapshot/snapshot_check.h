#pragma once
// Checks of an untrusted snapshot against the modules of a simulation.

#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "engine/snapshot.h"
#include "systems/snapshot/snapshot_records.h"
#include "systems/snapshot/snapshot_resources.h"

namespace mobil::inline v0_3 {

/// Checks that modules have the same version and component layouts here, and that their rows are valid.
Result<void> check_modules(const Records<SavedModule>& saved, const SavedWorld& world, std::span<const Module> modules);
/// Checks that every number of every row is finite, with the simulation's jobs.
Result<void> check_numbers(const SavedWorld& world, std::span<const Module> modules, const Jobs& jobs);
/// Checks that a table's shared resources belong to one muscle, and runs the modules' checks of its archetype.
Result<void> check_key(const Archetype& key, const World& world, const ResourceList& resources,
                       std::span<const Module> modules);
/// Checks that a muscle takes at most `most` steps a tick: by its table, and by a choice for later muscles.
Result<void> check_steps(const Archetype& key, const World& world, double tick_s, std::size_t most);

}  // namespace mobil::inline v0_3
