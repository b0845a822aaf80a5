#pragma once
// Two simulations that should hold the same, word by word.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/simulation.h>

namespace mobil {

/// Every word of a person's row but handles, then of their muscles' rows.
std::vector<std::uint32_t> person_words(const Simulation& simulation, Entity person);

/// Of all there is, table by table, with handles.
std::vector<std::uint32_t> world_words(const Simulation& simulation);

/// Displacements of all control points of a person's muscles, m, three numbers each, in the muscles' order.
std::vector<float> control_points(const Simulation& simulation, Entity person);

/// The largest of them, without sign; of two people with the same muscles the largest difference. Not-a-number where
/// one is.
double largest(const std::vector<float>& displacements);
double largest_difference(const std::vector<float>& a, const std::vector<float>& b);

/// How many differ; of lists of different lengths also what is missing.
std::size_t different_words(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

}  // namespace mobil
