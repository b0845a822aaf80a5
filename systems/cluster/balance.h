#pragma once
// Assigns shards to ranks, and plans moves that balance the load.

#include <cstdint>
#include <span>
#include <vector>

namespace mobil::inline v0_3 {

struct ShardMove {
  std::uint32_t shard = 0;
  int from = 0, to = 0;
};

/// Returns the initial rank of each shard, round robin.
std::vector<int> first_owners(std::uint32_t shards, int ranks);
/// Plans up to four moves from the cost of each shard (any unit): from the rank with the highest load to the lowest,
/// while that reduces the highest load by 1/20 of the mean. The result depends on the arguments only.
std::vector<ShardMove> plan_moves(std::span<const int> owner, std::span<const std::uint64_t> cost, int ranks);

}  // namespace mobil::inline v0_3
