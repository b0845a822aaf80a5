#pragma once
// Order of systems, computed from their accesses; mobil/schedule.h has the rules.

#include <cstddef>
#include <span>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/schedule.h>

namespace mobil::inline v0_3 {

/// Returns the systems' indices in running order, or an error.
Result<std::vector<std::size_t>> schedule_order(std::span<const System> systems);

/// Divides that order into passes, which run tile by tile. In a pass, no system looks up a part that another writes.
std::vector<SystemRange> schedule_passes(std::span<const System> ordered);

}  // namespace mobil::inline v0_3
