#pragma once
// Two simulations that should hold the same, word by word.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "systems/simulation.h"

namespace mobil {

/// Every word of one entity's row but handles, its own or others'.
std::vector<std::uint32_t> row_words(const Simulation& simulation, Entity entity);

/// Of a person: their row, then their muscles'.
std::vector<std::uint32_t> human_words(const Simulation& simulation, Entity human);

/// Of all there is, table by table, with handles.
std::vector<std::uint32_t> world_words(const Simulation& simulation);

/// How many differ; of lists of different lengths also what is missing.
std::size_t different_words(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

}  // namespace mobil
