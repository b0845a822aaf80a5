#pragma once
// Snapshots in files, and rollback over the last ticks. Simulation::save and restore make the snapshots themselves.
//
//   Rollback window(8);
//   window.keep(simulation);            // before each tick
//   …
//   window.back(simulation, 5);         // the state before the last five ticks; later snapshots are discarded

#include <cstddef>
#include <filesystem>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/simulation.h>
#include <mobil/systems/snapshot/restore_limits.h>

namespace mobil::inline v0_3 {

/// Writes a snapshot to a file. The data is written next to the target, flushed to disk and then renamed, so that a
/// killed program leaves the last good file or the complete new one. Errors: a folder that is missing or not writable,
/// a full disk, the errors of `save`; an existing file then stays.
Result<void> save_file(const Simulation& simulation, const std::filesystem::path& path);
/// Restores a snapshot from a file. The default has no limits on crowd and mesh sizes, because the file is trusted.
/// Errors: a file that cannot be read, the errors of `restore`; the simulation is then unchanged.
Result<void> restore_file(Simulation& simulation, const std::filesystem::path& path,
                          const RestoreLimits& limits = RestoreLimits::none());

/// The last snapshots of one simulation, in memory that grows with the crowd and is reused.
class Rollback {
 public:
  explicit Rollback(std::size_t ticks) : kept_(ticks) {}

  /// Adds a snapshot and replaces the oldest one when `ticks` are stored. Errors: those of `save`.
  Result<void> keep(const Simulation& simulation);
  /// Number of stored snapshots.
  std::size_t depth() const { return depth_; }
  /// Restores the `times`-th most recent snapshot (1: the latest), and discards it and all later ones. The following
  /// ticks add them again. Errors: fewer snapshots stored, the errors of `restore`; the simulation is then unchanged.
  Result<void> back(Simulation& simulation, std::size_t times);

 private:
  struct Kept {
    std::vector<std::byte> bytes;
    std::size_t used = 0;
  };
  std::vector<Kept> kept_;  // a ring
  std::size_t next_ = 0, depth_ = 0;
};

}  // namespace mobil::inline v0_3
