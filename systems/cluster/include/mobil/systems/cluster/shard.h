#pragma once
// A part of a crowd that is simulated by itself: one Simulation and what its host knows of its people. A crowd has as
// many shards on one rank as on a thousand, and a person belongs to a shard by number, for good. So what happens in a
// shard does not depend on where it is worked on, and a shard moves, is saved and is restored as a snapshot.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// The shard of a person. Numbers that follow each other lie in shards far from each other.
std::uint32_t shard_of(std::uint64_t number, std::uint32_t shards);

/// What a host's shard is to do. What it does may depend on its number, its state and the commands alone: not on
/// clocks, threads or ranks.
class Shard {
 public:
  virtual ~Shard() = default;

  /// The people that it begins with. Errors: what the simulation refuses.
  virtual Result<void> populate() = 0;
  /// Ticks run so far; shards that took more or fewer to begin are brought to the same.
  virtual std::uint32_t ticks() const = 0;
  /// Before a tick, the same commands in all shards; those to others are not for it. They come from the host's own
  /// first rank, or from a file that its user named. Errors stop the run: what is no more than a refused wish (somebody
  /// who has left) is none.
  virtual Result<void> apply(std::span<const std::byte> commands) = 0;
  virtual void tick() = 0;
  /// Simulation::state_sum, and that of what the host keeps besides, if it wants that compared.
  virtual std::uint64_t state_sum() const = 0;
  /// Everything, as bytes; and a shard just made, that is not populated, from them. Errors: bytes that do not fit.
  virtual Result<std::vector<std::byte>> save() const = 0;
  virtual Result<void> restore(std::span<const std::byte> saved) = 0;
};

}  // namespace mobil::inline v0_3
