#pragma once
// Fading of control points from one method to another.

#include <cstdint>

#include <mobil/components/fade.h>

namespace mobil::inline v0_3 {

/// Fades a block by one tick: `shown` = `displacement` + d·(1 + 2x)·(1 − x)² + v·T·x·(1 − x)², where x = elapsed / T.
/// This is the cubic from displacement d and velocity v at the change (`start`: 2·`words` floats × 16) to zero at rest
/// a time T = fade_s later. From then on `shown` equals `displacement` to the bit. A NaN stays in its lane.
void fade_out(const float* displacement, const float* start, std::uint32_t words, Fade<Lanes<float>>& fade,
              float* shown, float tick_s);

/// Remaining shares of d and of v (s), and their rates of change (1/s and 1).
struct FadeShare {
  float displacement, velocity, displacement_rate, velocity_rate;
};
FadeShare fade_share(float elapsed_s);

}  // namespace mobil::inline v0_3
