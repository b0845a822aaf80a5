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

#include "engine/error.h"

namespace mobil {

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
/// The last whole snapshot. Errors: there is none.
Result<SavedRun> last_snapshot(const std::filesystem::path& folder);

/// The commands of one tick, as they were logged.
struct LoggedCommands {
  std::uint32_t tick = 0;
  std::vector<std::byte> commands{};
};

/// The commands of each tick since a snapshot, written before anybody acts on them.
class CommandLog {
 public:
  /// An empty one beside the snapshot of that tick. Errors: it cannot be written.
  static Result<CommandLog> begin(const std::filesystem::path& folder, std::uint32_t tick);
  /// Reads the one that is there, if it is, up to what was cut or altered, and goes on behind it.
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

}  // namespace mobil
