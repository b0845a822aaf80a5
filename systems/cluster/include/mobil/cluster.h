#pragma once
// A crowd on several ranks: processes on one machine or on many, or threads in a test. Each works on some of the shards
// (mobil/systems/cluster/shard.h); within a tick they exchange nothing but the commands, which the first rank hands on.
//
//   Ranks ranks(**transport);
//   auto cluster = Cluster::begin(ranks, {.shards = 64, .folder = "run"}, [](std::uint32_t shard) {
//     return std::make_unique<PeopleShard>(shard, PeopleShardOptions{.shards = 64});
//   });
//   for (…) cluster->tick(commands);              // the first rank's count
//   cluster->state_hash();                        // the same on any number of ranks
//
// All ranks call the same functions in the same order. Where one of them fails within a tick the work of all ends, with
// one line that says where (Ranks::stop): a crowd of which a part is missing is of no use. A host that catches an
// exception does the same, for the others wait for it.

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

/// How a crowd is cut into shards, checked and saved.
struct ClusterOptions {
  std::uint32_t shards = 16;  // at least one a rank; several, where shards are to move
  /// The first rank is ahead of the others by so many ticks at most.
  std::uint32_t meet_every = 32;
  /// Ticks after which shards may move to ranks that have less to do; 0: never. What happens in them stays the same.
  std::uint32_t balance_every = 0;
  /// Where snapshots and commands go, in a folder that all ranks see; empty: nowhere.
  std::filesystem::path folder{};
  std::uint32_t save_every = 600;  // ticks; 0: at the beginning alone
  bool resume = false;             // go on from the last snapshot in the folder and the commands behind it
  /// What the run is asked for: a run that goes on must be asked for the same.
  std::string about{};
  /// What the first rank's host keeps besides shards, for the snapshot; may be empty.
  std::function<std::vector<std::byte>()> host{};
};

/// Of this rank, since `begin`.
struct ClusterReport {
  double worked_s = 0, waited_s = 0, saving_s = 0;
  std::uint64_t bytes_sent = 0, bytes_saved = 0;
  std::uint32_t ticks = 0, replayed = 0, moved = 0, snapshots = 0;
};

class Cluster {
 public:
  /// Makes the shard of that number.
  using Make = std::function<Result<std::unique_ptr<Shard>>(std::uint32_t shard)>;

  /// Makes this rank's shards and populates them, or restores them; brings them to the same tick. `ranks` must outlive
  /// the cluster. Errors, the same on all ranks: more ranks than shards, a shard that fails, a folder without a
  /// snapshot of such a run, or for a new run with one.
  static Result<Cluster> begin(Ranks& ranks, const ClusterOptions& options, Make make);

  /// One tick of all. `commands`: the first rank's; those of others are ignored, and so are the first rank's where the
  /// log of a run that goes on has some of that tick. What was carried out, until the next call.
  std::span<const std::byte> tick(std::span<const std::byte> commands = {});
  /// Ticks run so far.
  std::uint32_t ticks() const { return ticks_; }
  /// Of everybody. Where shards hand over Simulation::state_sum alone: that of one simulation that had them all, at the
  /// same tick.
  std::uint64_t state_hash();
  /// A snapshot now; nothing where the last one is of this tick. Errors, the same on all ranks: no folder was named, it
  /// cannot be written; the last one stays.
  Result<void> save();

  /// As the cluster was made with.
  const ClusterOptions& options() const { return options_; }
  /// `number`: below the options' shards. Null where another rank has it. Until the next `tick`, if shards may move.
  Shard* shard(std::uint32_t number) { return shards_[number].get(); }
  /// The rank that has each shard.
  std::span<const int> owner() const { return owner_; }
  /// What the host kept in the snapshot that the run went on from; at the first rank.
  const std::vector<std::byte>& restored_host() const { return restored_host_; }
  /// What this rank did since `begin`.
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
  std::vector<std::uint64_t> cost_us_;  // by shard, since shards moved last
  std::optional<FolderLock> lock_;      // at the first rank, and the next
  std::optional<CommandLog> log_;
  std::optional<std::uint32_t> saved_tick_;
  std::vector<LoggedCommands> replay_;
  std::vector<std::byte> restored_host_, carried_out_;
  std::uint32_t ticks_ = 0;
  ClusterReport report_;
};

}  // namespace mobil::inline v0_3
