#pragma once
// A part of a crowd that is simulated separately: one Simulation and the host's data about its people. The number of
// shards does not depend on the number of ranks, and a person's number determines the shard permanently. So the state
// of a shard does not depend on its rank, and shards are moved, saved and restored as snapshots.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Returns the shard of a person. Consecutive numbers are scattered over the shards.
std::uint32_t shard_of(std::uint64_t number, std::uint32_t shards);

/// Interface of a host's shard. Its behaviour must depend on its number, its state and the commands alone, not on
/// clocks, threads or ranks.
class Shard {
 public:
  virtual ~Shard() = default;

  /// Creates the initial people. Errors: those of the simulation.
  virtual Result<void> populate() = 0;
  /// Number of ticks run so far. Shards with different numbers after `populate` are brought to the same tick.
  virtual std::uint32_t ticks() const = 0;
  /// Executes commands before a tick. All shards get the same commands and must ignore those for other shards. They are
  /// from the host's own first rank, or from a file that its user named. Errors stop the run, so a command that merely
  /// cannot be executed (for a person who has left) must not be an error.
  virtual Result<void> apply(std::span<const std::byte> commands) = 0;
  virtual void tick() = 0;
  /// Returns Simulation::state_sum, plus a hash of the host's own data if they should be compared.
  virtual std::uint64_t state_sum() const = 0;
  /// Return the whole shard as bytes, and restore it in a new, unpopulated shard. Errors: bytes that do not match.
  virtual Result<std::vector<std::byte>> save() const = 0;
  virtual Result<void> restore(std::span<const std::byte> saved) = 0;
};

}  // namespace mobil::inline v0_3
