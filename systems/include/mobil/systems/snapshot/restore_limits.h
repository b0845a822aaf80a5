#pragma once
// Limits on the resources that restoring a snapshot can use.

#include <cstddef>
#include <limits>

namespace mobil::inline v0_3 {

/// Limits of `restore`. A snapshot's checksum detects accidents, not attackers, who can compute it as well. Bytes from
/// a network therefore need these limits, and the host must authenticate their sender. Defaults suit a peer of a game.
struct RestoreLimits {
  std::size_t rows = 1'000'000;  // people and muscles
  /// Maximum nodes of a mesh that must be made because no muscle of this simulation uses it yet. With 0 only meshes
  /// that this simulation has prepared are allowed (MuscleLibrary::prepare, load). Meshes that sleepers and compact
  /// people need later count as well; they are made on waking.
  std::size_t mesh_nodes = 500;
  double seconds = 10;           // time after which no further mesh, solver or basis is made
  bool numbers = true;           // true: checks every number and refuses those that are not finite
  std::size_t resources = 2000;  // meshes, solvers, bases and choices that rows share
  /// Maximum substeps of a muscle in a tick; 0 allows no muscles. The time of a tick also depends on the number of
  /// muscles.
  std::size_t steps = 2000;

  /// Returns limits for bytes that this program has made itself.
  static constexpr RestoreLimits none() {
    constexpr std::size_t any = (std::numeric_limits<std::size_t>::max)();
    return {any, any, std::numeric_limits<double>::infinity(), false, any, any};
  }
};

}  // namespace mobil::inline v0_3
