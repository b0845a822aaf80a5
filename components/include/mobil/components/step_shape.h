#pragma once
// The numbers that a steady step is made of, in the order in which they are fitted and kept.

#include <array>
#include <cstddef>
#include <string_view>

namespace mobil::inline v0_3 {

/// Numbers that belong together: where they begin, how many, by how much each is likely to change, whether lengths.
struct ShapePart {
  std::string_view name;
  std::size_t first, count;
  double scale;
  bool is_length = false;
};

/// Phases run from a leg's own heel strike: of its cycle (0 to 1), of a step (0 to 2), or of a part of either (0 to 1).
/// Lengths m, angles rad, of a body of 1.75 m. Harmonics: a mean (but for `aside`), then cosines, then sines.
namespace step_shape {
inline constexpr ShapePart hips_forward{"hips_forward", 0, 9, 0.01, true};  // beside even speed: harmonics of the step
inline constexpr ShapePart hips_up{"hips_up", 9, 9, 0.01, true};  // beside standing height: harmonics of the step
inline constexpr ShapePart trunk{"trunk", 18, 7, 0.03};           // lean of the chest: harmonics of the step
inline constexpr ShapePart aside{"aside", 25, 4, 0.01, true};     // hips to the left: harmonics 1 and 3 of the cycle
inline constexpr ShapePart strike{"strike", 29, 4, 0.1};          // foot pitch from heel strike to foot flat
inline constexpr ShapePart rise{"rise", 33, 5, 0.2};              // foot pitch from heel rise to toe-off
inline constexpr ShapePart times{"times", 38, 2, 0.02};  // foot flat and heel rise, later than usual, of the cycle
inline constexpr ShapePart swing_pitch{"swing_pitch", 40, 4, 0.3};
inline constexpr ShapePart swing_forward{"swing_forward", 44, 5, 0.1, true};
inline constexpr ShapePart swing_up{"swing_up", 49, 5, 0.03, true};
inline constexpr ShapePart pad_up{"pad_up", 54, 3, 0.004, true};  // how far the heel's pad yields, from heel strike on
inline constexpr ShapePart pad_forward{"pad_forward", 57, 3, 0.003, true};
inline constexpr ShapePart pressure{"pressure", 60, 8, 0.02,
                                    true};               // centre of pressure ahead of the ankle, over stance
inline constexpr ShapePart share{"share", 68, 3, 0.3};   // of the weight that a foot takes over
inline constexpr ShapePart split{"split", 71, 4, 0.05};  // fore-aft force between the feet: height of the point that
                                                         // they lean toward, and what they push apart
/// How many numbers there are, and the parts that they fall into, in their order.
inline constexpr std::size_t size = 75;
inline constexpr std::array parts = {hips_forward,  hips_up,  trunk,  aside,       strike,   rise,  times, swing_pitch,
                                     swing_forward, swing_up, pad_up, pad_forward, pressure, share, split};
}  // namespace step_shape

/// The numbers of one step, part by part.
using StepShape = std::array<double, step_shape::size>;

/// By how much each number is likely to change: what a fit takes its steps and weights from.
constexpr StepShape shape_scales() {
  StepShape scales{};
  for (const ShapePart& part : step_shape::parts) {
    for (std::size_t i = 0; i < part.count; ++i) scales[part.first + i] = part.scale;
  }
  return scales;
}

}  // namespace mobil::inline v0_3
