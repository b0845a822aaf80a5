#pragma once
// One steady gait cycle of a simulated walk: what measured walks are published as.

#include <functional>

#include <mobil/engine/error.h>
#include <mobil/simulation.h>

namespace mobil {

/// Walks until steady, then through one more cycle of the right leg. After each tick of it `row` is told where in the
/// cycle that leg is, in cycles from heel strike at 0 to the next at 1; from somewhat before to the first tick beyond
/// 1.1. Error: a walk too slow to get there.
Result<void> over_steady_cycle(Simulation& simulation, Entity human, const std::function<void(double)>& row);

}  // namespace mobil
