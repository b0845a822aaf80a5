#pragma once
// A run on disk, in a folder accessible to all ranks.
//
//   FOLDER/tick_0000000300/shard_0000 …   each written by its rank
//   FOLDER/tick_0000000300/index          written last, by the first rank; without it the snapshot is incomplete
//   FOLDER/tick_0000000300/commands       of the ticks until the next complete snapshot.
//
// If ranks are killed, the last complete snapshot and the commands after it remain, except one that was being written.
// Files are not protected against a loss of power (fsync).

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Content of the index.
struct SavedRun {
  std::uint32_t tick = 0, shards = 0;
  std::uint64_t state_hash = 0;
  std::string about{};            // description of the run
  std::vector<std::byte> host{};  // data of the first rank's host
};
std::vector<std::byte> pack(const SavedRun& run);
Result<SavedRun> unpack_run(std::span<const std::byte> bytes);

/// Writes a shard to a file. Errors: a folder that cannot be created or written.
Result<void> write_shard(const std::filesystem::path& folder, std::uint32_t tick, std::uint32_t shard,
                         std::span<const std::byte> bytes);
/// Reads a shard from a file. Errors: a missing, truncated or altered file, another shard or tick.
Result<std::vector<std::byte>> read_shard(const std::filesystem::path& folder, std::uint32_t tick, std::uint32_t shard);
/// Completes a snapshot, the new last one. Removes incomplete snapshots, and older ones except the previous.
Result<void> write_index(const std::filesystem::path& folder, const SavedRun& run);
/// Returns the complete snapshots, the last first. Errors: no complete snapshot.
Result<std::vector<SavedRun>> whole_snapshots(const std::filesystem::path& folder);
/// Returns true if the folder contains a run, complete or not.
bool holds_a_run(const std::filesystem::path& folder);

/// Prevents other runs from writing to the folder during its lifetime. A killed run releases its lock.
class FolderLock {
 public:
  /// Locks the folder and creates it if missing. Errors: a folder locked by another run or not writable.
  static Result<FolderLock> take(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int file) : file_(file) {}
  int file_;
};

/// Logged commands of one tick.
struct LoggedCommands {
  std::uint32_t tick = 0;
  std::vector<std::byte> commands{};
};

/// Log of the commands of each tick since a snapshot, written before any rank executes them.
class CommandLog {
 public:
  /// Starts the log of the snapshot of that tick, with initial commands. Errors: a file that cannot be written.
  static Result<CommandLog> begin(const std::filesystem::path& folder, std::uint32_t tick,
                                  std::span<const LoggedCommands> first);
  /// Reads all commands since the snapshot of that tick, from its log and those of later snapshots, and appends from
  /// there on. An incomplete last record is dropped. Errors: an altered record, missing ticks.
  static Result<CommandLog> resume(const std::filesystem::path& folder, std::uint32_t tick,
                                   std::vector<LoggedCommands>& logged);
  Result<void> add(std::uint32_t tick, std::span<const std::byte> commands);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace mobil::inline v0_3
