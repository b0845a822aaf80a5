#pragma once
// How much a snapshot may ask for.

#include <cstddef>
#include <limits>

namespace mobil {

/// What `restore` may take and do. A snapshot's seal tells accidents, not attackers, who can seal what they please:
/// bytes from a network need these limits, and to be told whose they are by the host. Defaults are for one of a game's
/// peers.
struct RestoreLimits {
  std::size_t rows = 1'000'000;  // people and muscles
  /// Nodes of any one mesh that must be made, because no muscle here has it yet. 0: nothing is made that this
  /// simulation has not prepared (Simulation::prepare, load_baked).
  std::size_t mesh_nodes = 500;
  double seconds = 10;       // after which no further mesh, solver or basis is made
  std::size_t steps = 2000;  // that any one muscle may take in a tick
  bool numbers = true;       // whether every number is looked at: one that is not finite is refused

  /// For bytes that this program has made itself.
  static constexpr RestoreLimits none() {
    constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
    return {any, any, std::numeric_limits<double>::infinity(), any, false};
  }
};

}  // namespace mobil
