#pragma once
// What shape tables are polynomials of: the shortening e of a belly, and a root of its activation.

#include <array>
#include <cmath>
#include <cstddef>

namespace mobil::inline v0_3 {

inline constexpr std::size_t shape_amount_count = 11, shape_ratio_terms = 3;
/// Vectors of a table that is kept. With five, plantaris is off by 11 % at worst instead of 5; more change nothing.
inline constexpr std::size_t shape_modes = 6;

/// Of activation_root: the one that fits best (0.003 to 0.1 tried).
inline constexpr double activation_offset = 0.01;

/// ρ of an activation a, 0 to 1 as it is: steep where fibres begin to outweigh the tissue around them.
inline double activation_root(double activation) {
  const double least = std::sqrt(activation_offset);
  return (std::sqrt(activation + activation_offset) - least) / (std::sqrt(1 + activation_offset) - least);
}

/// f: all 0 at rest. Without the last, shapes are off by up to a fifth more.
template <class F>
std::array<F, shape_amount_count> shape_amounts(F e, F root) {
  const F e2 = e * e, root2 = root * root;
  return {e, e2, e * e2, root, e * root, root2, e2 * root, e * root2, root * root2, e * e2 * root, e * root * root2};
}

}  // namespace mobil::inline v0_3
