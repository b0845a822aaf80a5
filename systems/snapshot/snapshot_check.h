#pragma once
// Whether an untrusted snapshot fits the modules of a simulation.

#include <span>

#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include "engine/snapshot.h"
#include "systems/snapshot/snapshot_records.h"
#include "systems/snapshot/snapshot_resources.h"

namespace mobil::inline v0_3 {

/// Parts are laid out as their modules have them, of the version that these have here, and their rows are sound.
Result<void> check_modules(const Records<SavedModule>& saved, const SavedWorld& world, std::span<const Module> modules);
/// Every number of every row is finite. With the simulation's jobs.
Result<void> check_numbers(const SavedWorld& world, std::span<const Module> modules, const Jobs& jobs);
/// A table's shared resources are those of one muscle; and what its modules make sure of.
Result<void> check_key(const Archetype& key, const World& world, const ResourceList& resources,
                       std::span<const Module> modules);
/// A muscle takes at most so many steps in a tick: as its table says, and as a choice says that later muscles follow.
Result<void> check_steps(const Archetype& key, const World& world, double tick_s, std::size_t most);

}  // namespace mobil::inline v0_3
