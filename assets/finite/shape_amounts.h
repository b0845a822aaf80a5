#pragma once
// The polynomial terms of shape tables: the shortening e of a belly, and a root of its activation.

#include <array>
#include <cmath>
#include <cstddef>

namespace mobil::inline v0_3 {

inline constexpr std::size_t shape_amount_count = 11, shape_ratio_terms = 3;
/// Modes of a stored table. With five, plantaris is off by 11 % at worst instead of 5; more change nothing.
inline constexpr std::size_t shape_modes = 6;

/// Offset of activation_root that fits best (0.003 to 0.1 tried).
inline constexpr double activation_offset = 0.01;

/// Returns ρ of an activation a, 0 to 1 like a. It is steep where fibres start to outweigh the tissue around them.
inline double activation_root(double activation) {
  const double least = std::sqrt(activation_offset);
  return (std::sqrt(activation + activation_offset) - least) / (std::sqrt(1 + activation_offset) - least);
}

/// Returns f, all 0 at rest. Without the last, shapes are off by up to a fifth more.
template <class F>
std::array<F, shape_amount_count> shape_amounts(F e, F root) {
  const F e2 = e * e, root2 = root * root;
  return {e, e2, e * e2, root, e * root, root2, e2 * root, e * root2, root * root2, e * e2 * root, e * root * root2};
}

}  // namespace mobil::inline v0_3
