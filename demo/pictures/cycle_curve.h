#pragma once
// A quantity over the gait cycle of one leg.

#include <array>
#include <cstddef>

namespace mobil {

/// Number of points, every 2 % from heel strike (0) to the next (100 %). The last point repeats the first.
inline constexpr std::size_t cycle_points = 51;
using CycleCurve = std::array<double, cycle_points>;

/// Mean and standard deviation between people.
struct MeasuredCurve {
  CycleCurve mean{}, sd{};
};

}  // namespace mobil
