#pragma once
// The order in which systems run, from what they read and write; the rules stand in engine/schedule.h.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/error.h"
#include "engine/schedule.h"

namespace mobil {

/// Indices of the systems in the order of running, or what is wrong with them.
Result<std::vector<std::size_t>> schedule_order(std::span<const System> systems);

}  // namespace mobil
