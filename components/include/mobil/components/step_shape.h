#pragma once
// Shape parameters of a steady step, in the order in which they are fitted and stored.

#include <array>
#include <cstddef>
#include <string_view>

namespace mobil::inline v0_3 {

/// A group of parameters: first index, count, typical change, and true if they are lengths.
struct ShapePart {
  std::string_view name;
  std::size_t first, count;
  double scale;
  bool is_length = false;
};

/// Phases start at a leg's own heel strike and span its cycle (0 to 1), a step (0 to 2), or a part of either (0 to 1).
/// Lengths m, angles rad, of a body of 1.75 m. Harmonics: a mean (except in `aside`), then cosines, then sines.
namespace step_shape {
inline constexpr ShapePart hips_forward{"hips_forward", 0, 9, 0.01, true};  // minus even motion: harmonics of the step
inline constexpr ShapePart hips_up{"hips_up", 9, 9, 0.01, true};  // above standing height: harmonics of the step
inline constexpr ShapePart trunk{"trunk", 18, 7, 0.03};           // lean of the chest: harmonics of the step
inline constexpr ShapePart aside{"aside", 25, 4, 0.01, true};     // hips to the left: harmonics 1 and 3 of the cycle
inline constexpr ShapePart strike{"strike", 29, 4, 0.1};          // foot pitch from heel strike to foot flat
inline constexpr ShapePart rise{"rise", 33, 5, 0.2};              // foot pitch from heel rise to toe-off
inline constexpr ShapePart times{"times", 38, 2, 0.02};  // foot flat and heel rise, later than usual, of the cycle
inline constexpr ShapePart swing_pitch{"swing_pitch", 40, 4, 0.3};
inline constexpr ShapePart swing_forward{"swing_forward", 44, 5, 0.1, true};
inline constexpr ShapePart swing_up{"swing_up", 49, 5, 0.03, true};
inline constexpr ShapePart pad_up{"pad_up", 54, 3, 0.004, true};  // compression of the heel pad, from heel strike on
inline constexpr ShapePart pad_forward{"pad_forward", 57, 3, 0.003, true};
inline constexpr ShapePart pressure{"pressure", 60, 8, 0.02,
                                    true};               // centre of pressure ahead of the ankle, over stance
inline constexpr ShapePart share{"share", 68, 3, 0.3};   // of the weight, taken over by a foot
inline constexpr ShapePart split{"split", 71, 4, 0.05};  // fore-aft force between the feet: height of the point that
                                                         // they lean toward, and the force that pushes them apart
/// Number of parameters, and their groups in order.
inline constexpr std::size_t size = 75;
inline constexpr std::array parts = {hips_forward,  hips_up,  trunk,  aside,       strike,   rise,  times, swing_pitch,
                                     swing_forward, swing_up, pad_up, pad_forward, pressure, share, split};
}  // namespace step_shape

/// All parameters of one step, group by group.
using StepShape = std::array<double, step_shape::size>;

/// Returns the typical change of each parameter, from which a fit takes its steps and weights.
constexpr StepShape shape_scales() {
  StepShape scales{};
  for (const ShapePart& part : step_shape::parts) {
    for (std::size_t i = 0; i < part.count; ++i) scales[part.first + i] = part.scale;
  }
  return scales;
}

}  // namespace mobil::inline v0_3
