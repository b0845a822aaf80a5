#pragma once
// Places among stations, and turns: what tables of sections are looked up by.

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <utility>

namespace mobil::inline v0_3::form {

/// A full turn, rad.
inline constexpr double tau = 2 * std::numbers::pi;

/// Where `at` lies among rising keys: the one before, and how far towards the next (0–1).
template <class Key>
std::pair<std::size_t, double> between(std::size_t count, double at, const Key& key) {
  std::size_t k = 0;
  while (k + 2 < count && key(k + 1) < at) ++k;
  return {k, std::clamp((at - key(k)) / (key(k + 1) - key(k)), 0.0, 1.0)};
}

}  // namespace mobil::inline v0_3::form
