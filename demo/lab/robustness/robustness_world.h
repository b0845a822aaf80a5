#pragma once
// Word-by-word comparison of two simulations that should be equal.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <mobil/simulation.h>

namespace mobil {

/// Returns every word of a person's row except handles, then of their muscles' rows.
std::vector<std::uint32_t> person_words(const Simulation& simulation, Entity person);

/// Returns all words of a world, table by table, with handles.
std::vector<std::uint32_t> world_words(const Simulation& simulation);

/// Returns displacements of all control points of a person's muscles, m, three numbers each, in the muscles' order.
std::vector<float> control_points(const Simulation& simulation, Entity person);

/// Return the largest absolute displacement, and the largest absolute difference of two people with the same muscles.
/// NaN if any number is.
double largest(const std::vector<float>& displacements);
double largest_difference(const std::vector<float>& a, const std::vector<float>& b);

/// Counts differing words; of lists of different lengths also the missing ones.
std::size_t different_words(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

}  // namespace mobil
