#pragma once
// Interpolation among stations, and turns: lookup in tables of sections.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <utility>

namespace mobil::inline v0_3::form {

/// A full turn, rad.
inline constexpr double tau = 2 * std::numbers::pi;

/// Returns the index of the rising key before `at`, and the fraction of the way to the next key (0–1).
template <class Key>
std::pair<std::size_t, double> between(std::size_t count, double at, const Key& key) {
  std::size_t k = 0;
  while (k + 2 < count && key(k + 1) < at) ++k;
  return {k, std::clamp((at - key(k)) / (key(k + 1) - key(k)), 0.0, 1.0)};
}

}  // namespace mobil::inline v0_3::form
