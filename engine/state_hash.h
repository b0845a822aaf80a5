#pragma once
// Hash of a world's state.

#include <cstdint>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Returns a hash of all rows with their parts, each with its members' rows (mobil/engine/members.h), and of shared
/// resources with a content hash. It is independent of creation order, row positions and handles. Only components that
/// contain other handles depend on those.
std::uint64_t state_hash(const World& world, const Jobs& jobs);

/// Returns a hash of the data common to a table's rows; for a shared resource its content hash.
std::uint64_t key_hash(const World& world, const Archetype& key);

/// Combines the tick with `sum`, the hash of the world, or the sum over a crowd's worlds, modulo 2⁶⁴.
std::uint64_t state_hash_of(std::uint64_t sum, std::uint32_t tick);

}  // namespace mobil::inline v0_3
