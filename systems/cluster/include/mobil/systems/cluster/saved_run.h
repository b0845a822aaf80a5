#pragma once
// A run on disk, in a folder that all ranks see:
//
//   FOLDER/tick_0000000300/shard_0000 …   each written by the rank that has it
//   FOLDER/tick_0000000300/index          written last, by the first rank: without it the snapshot is not there
//   FOLDER/tick_0000000300/commands       of the ticks from then on, until the next snapshot is whole
//
// Whenever ranks are killed, the last whole snapshot and the commands behind it are there, but for a command that was
// being written. Files are not made safe against a loss of power (fsync).

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

/// What the index says.
struct SavedRun {
  std::uint32_t tick = 0, shards = 0;
  std::uint64_t state_hash = 0;
  std::string about{};            // what the run was asked for
  std::vector<std::byte> host{};  // what the first rank's host keeps besides shards
};
std::vector<std::byte> pack(const SavedRun& run);
Result<SavedRun> unpack_run(std::span<const std::byte> bytes);

/// Errors: a folder that cannot be made or written.
Result<void> write_shard(const std::filesystem::path& folder, std::uint32_t tick, std::uint32_t shard,
                         std::span<const std::byte> bytes);
/// Errors: a file that is not there, was cut or altered, or is of another shard or tick.
Result<std::vector<std::byte>> read_shard(const std::filesystem::path& folder, std::uint32_t tick, std::uint32_t shard);
/// From here on that snapshot is the last one; all but the one before it, and what was left unfinished, are removed.
Result<void> write_index(const std::filesystem::path& folder, const SavedRun& run);
/// Whole snapshots, the last first. Errors: there is none.
Result<std::vector<SavedRun>> whole_snapshots(const std::filesystem::path& folder);
/// Whether a run has left something there, whole or not.
bool holds_a_run(const std::filesystem::path& folder);

/// While one lives, no other run writes into the folder; a run that was killed holds nothing.
class FolderLock {
 public:
  /// Makes the folder where it is not there. Errors: another run has it; it cannot be written.
  static Result<FolderLock> take(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  ~FolderLock();

 private:
  explicit FolderLock(int file) : file_(file) {}
  int file_;
};

/// The commands of one tick, as they were logged.
struct LoggedCommands {
  std::uint32_t tick = 0;
  std::vector<std::byte> commands{};
};

/// The commands of each tick since a snapshot, written before anybody acts on them.
class CommandLog {
 public:
  /// One beside the snapshot of that tick, with these in it. Errors: it cannot be written.
  static Result<CommandLog> begin(const std::filesystem::path& folder, std::uint32_t tick,
                                  std::span<const LoggedCommands> first);
  /// Reads what was logged since the snapshot of that tick, in its log and in those of later snapshots, and goes on
  /// behind it. A record that was being written is dropped. Errors: a record that was altered, ticks that are missing.
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
