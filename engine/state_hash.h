#pragma once
// The state of a world in one number.

#include <cstdint>

#include <mobil/engine/jobs.h>
#include <mobil/engine/world.h>

namespace mobil::inline v0_3 {

/// Of all rows with the parts that they have, each row with its members' (mobil/engine/members.h), and of shared
/// resources that were given a content. The same whatever order entities came in, whatever rows they lie in and
/// whatever handles they have; other components that hold handles make it depend on those.
std::uint64_t state_hash(const World& world, const Jobs& jobs);

/// Of what a table's rows have in common and do not hold themselves; of a shared resource its content.
std::uint64_t key_hash(const World& world, const Archetype& key);

/// The same with the tick. `sum`: of the world, or of all worlds that a crowd is divided into, modulo 2⁶⁴.
std::uint64_t state_hash_of(std::uint64_t sum, std::uint32_t tick);

}  // namespace mobil::inline v0_3
