#pragma once
// Shape parameters of a steady running step, in the order in which they are fitted and stored.

#include <array>
#include <cstddef>

#include <mobil/components/step_shape.h>

namespace mobil::inline v0_3 {

/// Phases start at a leg's own contact and span its cycle (0 to 1), its stance (u, 0 to 1) or a part of either. The
/// left leg is half a cycle later, mirrored. Lengths m, angles rad, of a body whose legs have the scale 1.75 m; forces
/// in body weights. Harmonics: a mean (except in `side_lean` and `shoulders`), then cosines, then sines.
/// assets/gait/run_curves.h has the formulas.
namespace run_shape {
/// Ground force of one foot: u (1 − u) times Legendre polynomials of 2u − 1. Numbers 0 of `force_up` and
/// `force_forward` follow from the weight and from a steady speed, so these groups start with number 1.
inline constexpr ShapePart force_up{"force_up", 0, 8, 0.2};
inline constexpr ShapePart force_forward{"force_forward", 8, 8, 0.1};
/// Centre of mass at contact, ahead of the foothold and above the standing hips.
inline constexpr ShapePart centre{"centre", 16, 2, 0.02, true};
inline constexpr ShapePart trunk{"trunk", 18, 15, 0.03};   // lean of the chest: harmonics of the step
inline constexpr ShapePart flight{"flight", 33, 4, 0.01};  // lean added in flight: four terms of `flight_lean`
inline constexpr ShapePart strike{"strike", 37, 4, 0.1};   // foot pitch from contact to foot flat
inline constexpr ShapePart rise{"rise", 41, 5, 0.2};       // foot pitch from heel rise to toe-off
inline constexpr ShapePart times{"times", 46, 2, 0.02};    // foot flat and heel rise, later than usual
inline constexpr ShapePart swing_pitch{"swing_pitch", 48, 5, 0.3};
inline constexpr ShapePart swing_forward{"swing_forward", 53, 7, 0.1, true};
inline constexpr ShapePart swing_up{"swing_up", 60, 7, 0.05, true};
inline constexpr ShapePart pad_up{"pad_up", 67, 3, 0.004, true};  // compression of heel and shoe, from contact on
inline constexpr ShapePart pad_forward{"pad_forward", 70, 3, 0.003, true};
inline constexpr ShapePart force_aside{"force_aside", 73, 4, 0.1};  // to the left, of the right foot; as the others
inline constexpr ShapePart side_lean{"side_lean", 77, 6, 0.02};     // of the chest: harmonics 1, 3, 5 of the cycle
inline constexpr ShapePart shoulders{"shoulders", 83, 4, 0.05};     // turn, right side forward: harmonics 1, 3
/// Number of parameters, and their groups in order.
inline constexpr std::size_t size = 87;
inline constexpr std::array parts = {force_up,    force_forward, centre,      trunk,         flight,   strike,
                                     rise,        times,         swing_pitch, swing_forward, swing_up, pad_up,
                                     pad_forward, force_aside,   side_lean,   shoulders};
}  // namespace run_shape

/// All parameters of one running step, group by group.
using RunShape = std::array<double, run_shape::size>;

/// Returns the typical change of each parameter, from which a fit takes its steps and weights.
constexpr RunShape run_shape_scales() {
  RunShape scales{};
  for (const ShapePart& part : run_shape::parts) {
    for (std::size_t i = 0; i < part.count; ++i) scales[part.first + i] = part.scale;
  }
  return scales;
}

}  // namespace mobil::inline v0_3
