#pragma once
// The order in which systems run, from what they read and write; the rules stand in mobil/schedule.h.

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/schedule.h>

namespace mobil::inline v0_3 {

/// Indices of the systems in the order of running, or what is wrong with them.
Result<std::vector<std::size_t>> schedule_order(std::span<const System> systems);

/// What of that order runs as one pass, block by block. A system looks at other entities' rows only where those are
/// done, and nobody changes what another system of the pass looks up.
std::vector<SystemRange> schedule_passes(std::span<const System> ordered);

}  // namespace mobil::inline v0_3
