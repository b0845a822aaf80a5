#pragma once
// Snapshots in files, and a window of the last ticks to go back to. Snapshots themselves: Simulation::save and restore.
//
//   Rollback window(8);
//   window.keep(simulation);            // each tick, before it
//   …
//   window.back(simulation, 5);         // as it was before the fifth tick from now; what came after is forgotten

#include <cstddef>
#include <filesystem>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/simulation.h>

namespace mobil::inline v0_3 {

/// Written beside the target, made safe on the disk and then put in its place: whenever the program is killed, there is
/// the last good file, or this one whole. Errors, one line each: a folder that is not there or not writable, a full
/// disk, what `save` refuses; what was there stays.
Result<void> save_file(const Simulation& simulation, const std::filesystem::path& path);
/// Errors: a file that cannot be read, what `restore` refuses; the simulation is unchanged. Without limits on how large
/// a crowd is or how fine its meshes are: the file is one's own.
Result<void> restore_file(Simulation& simulation, const std::filesystem::path& path,
                          const RestoreLimits& limits = RestoreLimits::none());

/// The last snapshots of one simulation, in memory of its own that grows with the crowd and is kept.
class Rollback {
 public:
  explicit Rollback(std::size_t ticks) : kept_(ticks) {}

  /// The oldest gives way once there are as many as asked for.
  Result<void> keep(const Simulation& simulation);
  /// How many can be gone back.
  std::size_t depth() const { return depth_; }
  /// Restores the `times`-th most recent snapshot (1: the latest). That one and those after it are forgotten:
  /// running on, they are kept anew. Errors: not so many kept, what `restore` refuses; the simulation is unchanged.
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
