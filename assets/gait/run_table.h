#pragma once
// Running steps of all speeds and step lengths, fitted to measured running; see README.md in this folder.

#include <array>
#include <cstddef>

#include <mobil/components/run_shape.h>

namespace mobil::inline v0_3 {

namespace run_table {
inline constexpr std::size_t speed_count = 13, length_count = 3;
/// Speed over √(g · leg), the leg from hip to ground: 1.75 to 6.5 m/s for a leg of 0.9275 m. Step length over the usual
/// one of that speed.
inline constexpr std::array<double, speed_count> speed = {0.5802, 0.6630, 0.7459, 0.8288, 0.9946, 1.1603, 1.3261,
                                                          1.4918, 1.6576, 1.8234, 1.9891, 2.0720, 2.1549};
inline constexpr std::array<double, length_count> length = {0.92, 1.00, 1.08};
inline constexpr std::size_t usual = 1;  // of `length`

/// Distance of each foot's line from the running line for which steps are fitted, over the height.
inline constexpr double half_width = 0.0114;

/// Laws of the usual run: step frequency times √(leg/g), and one over the duty factor, each a line over speed.
inline constexpr double frequency_at_rest = 0.687, frequency_per_speed = 0.172;
inline constexpr double duty_at_rest = 2.051, duty_per_speed = 0.889;
}  // namespace run_table

/// Given values at a speed. Angles are harmonics of the cycle from a side's own contact, rad: the mean if there is one,
/// cosines, then sines.
struct RunGiven {
  double frequency;                       // of steps, times √(leg/g)
  double duty;                            // contact time over the cycle's
  std::array<double, 5> tilt;             // of the pelvis, anterior: mean and harmonics 2, 4
  std::array<double, 4> turn, list;       // of the pelvis, that side forward, and up: harmonics 1, 3
  std::array<double, 5> shoulder, elbow;  // flexion on that side, from the chest: mean and harmonics 1, 2
};

/// A step with the lengths of a body of height 1 m. The hips are sought from the centre of mass less its usual place
/// relative to the middle of the hips.
struct RunNode {
  std::array<float, run_shape::size> shape;
  std::array<float, 5> centre_ahead, centre_up;  // that place: a mean, then harmonics 1, 2 of the step
};

/// Nodes by speed and step length.
using RunNodes = std::array<std::array<RunNode, run_table::length_count>, run_table::speed_count>;

extern const std::array<RunGiven, run_table::speed_count> run_given;
extern const RunNodes run_nodes;

}  // namespace mobil::inline v0_3
