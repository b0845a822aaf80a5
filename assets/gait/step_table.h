#pragma once
// Steps of people of all speeds and step lengths, fitted to measured walking; see README.md in this folder.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/step_shape.h>

namespace mobil::inline v0_3 {

namespace step_table {
inline constexpr std::size_t speed_count = 9, length_count = 6;
/// Speed over √(g · leg), the leg from hip to ground; step length over the usual one of that speed.
inline constexpr std::array<double, speed_count> speed = {0.17, 0.24, 0.31, 0.38, 0.45, 0.52, 0.59, 0.66, 0.73};
inline constexpr std::array<double, length_count> length = {0.76, 0.88, 1.00, 1.06, 1.12, 1.20};
inline constexpr std::size_t usual = 2;  // of `length`
}  // namespace step_table

/// Given values at a speed: the usual step length (of the leg), one double support (of the cycle), the pelvis' mean
/// tilt, and its turn and list to each side (rad).
struct StepGiven {
  double step_length, double_support, pelvis_tilt, pelvis_rotation, pelvis_list;
};

/// A shape with the lengths of a body of height 1 m.
using TabledShape = std::array<float, step_shape::size>;

/// Bodies for which steps are fitted: the typical man and woman of 25 years, and child of 7 years.
enum class StepKind : std::uint8_t { man, woman, child };
inline constexpr std::size_t step_kinds = 3;

/// Shapes by speed and step length.
using StepShapes = std::array<std::array<TabledShape, step_table::length_count>, step_table::speed_count>;

extern const std::array<StepGiven, step_table::speed_count> step_given;
extern const StepShapes step_shapes_man, step_shapes_woman, step_shapes_child;
inline const StepShapes& step_shapes(StepKind kind) {
  return kind == StepKind::woman ? step_shapes_woman : kind == StepKind::child ? step_shapes_child : step_shapes_man;
}

}  // namespace mobil::inline v0_3
