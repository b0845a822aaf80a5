#pragma once
// Runs a crowd on several ranks: processes on one or more machines, or threads in a test. Each rank simulates some of
// the shards (mobil/systems/cluster/shard.h). Within a tick ranks exchange only commands, which the first rank
// distributes.
//
//   Ranks ranks(**transport);
//   auto cluster = Cluster::begin(ranks, {.shards = 64, .folder = "run"}, [](std::uint32_t shard) {
//     return std::make_unique<PeopleShard>(shard, PeopleShardOptions{.shards = 64});
//   });
//   for (…) cluster->tick(commands);              // only the first rank's are used
//   cluster->state_hash();                        // the same on any number of ranks
//
// All ranks must call the same functions in the same order. If one fails within a tick, all end with one line that
// names the place (Ranks::stop): an incomplete crowd is useless. A host that catches an exception must do the same,
// because the other ranks wait for it.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/systems/cluster/ranks.h>
#include <mobil/systems/cluster/saved_run.h>
#include <mobil/systems/cluster/shard.h>

namespace mobil::inline v0_3 {

/// Division of a crowd into shards, load balancing and snapshots.
struct ClusterOptions {
  std::uint32_t shards = 16;  // at least one for each rank; several if shards should move
  /// Maximum number of ticks by which the first rank is ahead of the others.
  std::uint32_t meet_every = 32;
  /// Number of ticks after which shards can move to less loaded ranks; 0: never. Their state does not depend on it.
  std::uint32_t balance_every = 0;
  /// Folder for snapshots and commands, accessible to all ranks; empty: none.
  std::filesystem::path folder{};
  std::uint32_t save_every = 600;  // ticks; 0: at the start only
  bool resume = false;             // continue from the last snapshot in the folder and the commands after it
  /// Description of the run. A resumed run must have the same one.
  std::string about{};
  /// Returns data of the first rank's host to be stored in the snapshot; can be empty.
  std::function<std::vector<std::byte>()> host{};
};

/// Work of this rank since `begin`.
struct ClusterReport {
  double worked_s = 0, waited_s = 0, saving_s = 0;
  std::uint64_t bytes_sent = 0, bytes_saved = 0;
  std::uint32_t ticks = 0, replayed = 0, moved = 0, snapshots = 0;
};

class Cluster {
 public:
  /// Makes the shard with that number.
  using Make = std::function<Result<std::unique_ptr<Shard>>(std::uint32_t shard)>;

  /// Makes this rank's shards, populates or restores them, and brings them to the same tick. `ranks` must outlive the
  /// cluster. Errors, the same on all ranks: more ranks than shards, a shard that fails, a resumed run without a
  /// matching snapshot, a new run in a folder with one.
  static Result<Cluster> begin(Ranks& ranks, const ClusterOptions& options, Make make);

  /// Runs one tick of all shards. Commands of other ranks than the first are ignored. A resumed run uses logged
  /// commands as long as there are some. Returns the executed commands, valid until the next call.
  std::span<const std::byte> tick(std::span<const std::byte> commands = {});
  /// Number of ticks run so far.
  std::uint32_t ticks() const { return ticks_; }
  /// Returns the hash of the crowd: that of one simulation of all people, if shards return Simulation::state_sum only.
  std::uint64_t state_hash();
  /// Writes a snapshot, unless the last one is of this tick. Errors, the same on all ranks: no folder, or one that
  /// cannot be written; the last snapshot stays.
  Result<void> save();

  /// Returns the options given at construction.
  const ClusterOptions& options() const { return options_; }
  /// Returns a shard (`number` below the options' shards), or null if another rank has it. If shards can move, it is
  /// valid until the next `tick`.
  Shard* shard(std::uint32_t number) { return shards_[number].get(); }
  /// Rank of each shard.
  std::span<const int> owner() const { return owner_; }
  /// Returns the host's data of the resumed snapshot, at the first rank.
  const std::vector<std::byte>& restored_host() const { return restored_host_; }
  /// Returns the work of this rank since `begin`.
  ClusterReport report() const;

 private:
  Cluster(Ranks& ranks, const ClusterOptions& options, Make make);
  Result<void> make_own();
  Result<void> populate();
  Result<void> restore();
  Result<void> restore_from(const SavedRun& run);
  std::span<const std::byte> commands_of_tick(std::span<const std::byte> commands);
  void write_snapshot(std::uint64_t hash, Result<void>& own);
  void balance();

  Ranks* ranks_;
  ClusterOptions options_;
  Make make_;
  std::vector<std::unique_ptr<Shard>> shards_;
  std::vector<int> owner_;
  std::vector<std::uint64_t> cost_us_;  // by shard, since the last balancing
  std::optional<FolderLock> lock_;      // like the next, at the first rank only
  std::optional<CommandLog> log_;
  std::optional<std::uint32_t> saved_tick_;
  std::vector<LoggedCommands> replay_;
  std::vector<std::byte> restored_host_, carried_out_;
  std::uint32_t ticks_ = 0;
  ClusterReport report_;
};

}  // namespace mobil::inline v0_3
