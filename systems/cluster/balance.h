#pragma once
// Which rank has which shard, and which move so that all ranks have about as much to do.

#include <cstdint>
#include <span>
#include <vector>

namespace mobil::inline v0_3 {

struct ShardMove {
  std::uint32_t shard = 0;
  int from = 0, to = 0;
};

/// At the beginning: by turns.
std::vector<int> first_owners(std::uint32_t shards, int ranks);
/// What moves, given what each shard cost (any unit): from the rank with most to that with least, as long as the most
/// falls by a twentieth of the mean; at most four. The same for the same numbers.
std::vector<ShardMove> plan_moves(std::span<const int> owner, std::span<const std::uint64_t> cost, int ranks);

}  // namespace mobil::inline v0_3
