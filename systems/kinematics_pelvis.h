#pragma once
// When in a step the pelvis turns, lists, tilts and shifts: phases as fractions of the step from heel strike of the
// stance leg, from the first harmonics of Schwartz, Rozumalski & Trost 2008 (free speed). Seen from the stance leg:
//   rotation (that side forward) = A cos π(t/T − rotation)
//   list (that side up) = A (first cos π(t/T − first phase) + third cos 3π(t/T − third phase))
//   tilt (anterior) = mean + A cos 2π(t/T − tilt)
//   shift (toward that side) = A sin π(t/T − half a double support)
// The odd harmonics change sign from one step to the next as the sides change, so all are smooth through heel strike.

namespace mobil::pelvis_phase {
inline constexpr double rotation = 0.16;
inline constexpr double list_first = 0.70, list_first_phase = 0.272;
inline constexpr double list_third = 0.30, list_third_phase = 0.314;
inline constexpr double tilt = -0.166;
}  // namespace mobil::pelvis_phase
