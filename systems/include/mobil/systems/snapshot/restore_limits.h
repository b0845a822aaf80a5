#pragma once
// How much a snapshot may ask for.

#include <cstddef>
#include <limits>

namespace mobil::inline v0_3 {

/// What `restore` may take and do. A snapshot's seal tells accidents, not attackers, who can seal what they please:
/// bytes from a network need these limits, and to be told whose they are by the host. Defaults are for one of a game's
/// peers.
struct RestoreLimits {
  std::size_t rows = 1'000'000;  // people and muscles
  /// Nodes of any one mesh that must be made, because no muscle here has it yet. 0: no mesh is made that this
  /// simulation has not prepared (MuscleLibrary::prepare, load). What sleepers and compact people are to have later
  /// counts, too; it is made when they wake.
  std::size_t mesh_nodes = 500;
  double seconds = 10;           // after which no further mesh, solver or basis is made
  bool numbers = true;           // whether every number is looked at: one that is not finite is refused
  std::size_t resources = 2000;  // meshes, solvers, bases and choices that rows share
  /// That any one muscle may take in a tick; what a tick takes follows from the muscles that there are, too. 0: no
  /// muscles.
  std::size_t steps = 2000;

  /// For bytes that this program has made itself.
  static constexpr RestoreLimits none() {
    constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
    return {any, any, std::numeric_limits<double>::infinity(), false, any, any};
  }
};

}  // namespace mobil::inline v0_3
