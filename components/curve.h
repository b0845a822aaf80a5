#pragma once
// A smooth curve as a component stores it.

#include <cstddef>

namespace mobil {

/// A smooth curve over a known time: cubic Hermite through equally spaced knots; slopes are per interval, not per
/// second.
inline constexpr std::size_t knot_count = 17;
template <class F>
struct Curve {
  F value[knot_count], slope[knot_count];
};

}  // namespace mobil
