#include "systems/cluster/balance.h"

#include <algorithm>
#include <cstddef>

namespace mobil::inline v0_3 {
namespace {

constexpr std::size_t max_moves = 4;
constexpr std::uint64_t worth = 20;  // a move must gain 1/20 of the mean load

}  // namespace

std::vector<int> first_owners(std::uint32_t shards, int ranks) {
  std::vector<int> owner(shards);
  for (std::uint32_t s = 0; s < shards; ++s) owner[s] = static_cast<int>(s % static_cast<std::uint32_t>(ranks));
  return owner;
}

std::vector<ShardMove> plan_moves(std::span<const int> owner, std::span<const std::uint64_t> cost, int ranks) {
  std::vector<int> now(owner.begin(), owner.end());
  std::vector<std::uint64_t> load(static_cast<std::size_t>(ranks), 0);
  std::uint64_t all = 0;
  for (std::size_t s = 0; s < now.size(); ++s) {
    load[static_cast<std::size_t>(now[s])] += cost[s];
    all += cost[s];
  }
  const std::uint64_t gain = all / static_cast<std::uint64_t>(ranks) / worth;
  std::vector<ShardMove> moves;
  while (moves.size() < max_moves) {
    const auto heavy = std::ranges::max_element(load), light = std::ranges::min_element(load);
    const int from = static_cast<int>(heavy - load.begin()), to = static_cast<int>(light - load.begin());
    std::size_t best = now.size();
    std::uint64_t least = *heavy;  // minimum of the larger load after the move
    for (std::size_t s = 0; s < now.size(); ++s) {
      if (now[s] != from || cost[s] > *heavy) continue;
      const std::uint64_t larger = std::max(*heavy - cost[s], *light + cost[s]);
      if (larger >= least) continue;
      least = larger;
      best = s;
    }
    if (best == now.size() || least + std::max<std::uint64_t>(gain, 1) > *heavy) break;
    *heavy -= cost[best];
    *light += cost[best];
    now[best] = to;
    moves.push_back({static_cast<std::uint32_t>(best), from, to});
  }
  return moves;
}

}  // namespace mobil::inline v0_3
