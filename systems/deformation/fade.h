#pragma once
// Control points on their way from one method to another.

#include <cstdint>

#include <mobil/components/fade.h>

namespace mobil::inline v0_3 {

/// One tick of a block: `shown` = `displacement` + d·(1 + 2x)·(1 − x)² + v·T·x·(1 − x)², the cubic from displacement d
/// and velocity v at the change (`start`: 2·`words` floats × 16) to rest at nothing a time T = fade_s later, x =
/// elapsed / T. From then on `shown` is `displacement`, to the bit. A NaN stays in its lane.
void fade_out(const float* displacement, const float* start, std::uint32_t words, Fade<Lanes<float>>& fade,
              float* shown, float tick_s);

/// How much of d and of v (s) is left, and how fast that changes (1/s and 1).
struct FadeShare {
  float displacement, velocity, displacement_rate, velocity_rate;
};
FadeShare fade_share(float elapsed_s);

}  // namespace mobil::inline v0_3
