#pragma once
// Saving and restoring the state of a simulation as bytes: a world's rows, entities and time, and recipes of its shared
// resources. The code is independent of people: modules list and check their components (mobil/engine/module.h).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/module.h>
#include <mobil/engine/world.h>
#include <mobil/systems/snapshot/restore_limits.h>
#include "engine/snapshot.h"
#include "systems/bellies/belly_library.h"
#include "systems/snapshot/snapshot_records.h"
#include "systems/snapshot/snapshot_resources.h"

namespace mobil::inline v0_3 {

/// Source or target of a snapshot. `W` is World, const for saving.
template <class W>
struct SnapshotSceneOf {
  W& world;
  BellyLibrary& library;
  std::span<const Module> modules;
  const Jobs& jobs;
};
using SnapshotScene = SnapshotSceneOf<const World>;
using RestoreScene = SnapshotSceneOf<World>;

/// A clock's units (mobil/engine/clock.h) and the number of ticks.
struct SnapshotTime {
  std::int64_t tick_units = 0, remainder_units = 0;
  std::uint32_t tick = 0;
};

/// A component that no module names, and the numbers of the tables that have it.
struct UnnamedPart {
  ComponentId part;
  std::vector<std::size_t> tables;
};

/// Scratch memory of saving and restoring, reused between calls.
struct SnapshotWork {
  ResourceList resources;
  WorldSnapshot world;
  std::vector<std::uint8_t> used;  // resources, by number
  std::vector<SharedNumber> shared;
  std::vector<ComponentId> parts;  // of all modules
  std::vector<UnnamedPart> unnamed;
  std::size_t tables_seen = 0;
};

std::size_t snapshot_bytes(const SnapshotScene& scene, SnapshotWork& work);
/// Writes a snapshot and returns its size, bytes. Errors: too little room; a shared resource that no module names.
Result<std::size_t> save_snapshot(const SnapshotScene& scene, const SnapshotTime& time, SnapshotWork& work,
                                  std::span<std::byte> out);
/// Restores a snapshot and returns its time. `present`: the simulation's time; its ticks must have the same length.
/// Errors: bytes that are not a snapshot of this version, were altered, do not fit the modules, or exceed memory or the
/// limits. The world is unchanged then.
Result<SnapshotTime> restore_snapshot(const RestoreScene& scene, const SnapshotTime& present, SnapshotWork& work,
                                      const RestoreLimits& limits, std::span<const std::byte> in);

}  // namespace mobil::inline v0_3
