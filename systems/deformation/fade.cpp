#include "systems/deformation/fade.h"

#include <algorithm>
#include <cstddef>

namespace mobil::inline v0_3 {

FadeShare fade_share(float elapsed_s) {
  const float x = std::min(elapsed_s / fade_s, 1.0F), left = 1.0F - x;
  return {(1.0F + 2.0F * x) * left * left, fade_s * x * left * left, -6.0F * x * left / fade_s,
          left * (1.0F - 3.0F * x)};
}

void fade_out(const float* displacement, const float* start, std::uint32_t words, Fade<Lanes<float>>& fade,
              float* shown, float tick_s) {
  Lanes<float> d, v;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const FadeShare share = fade_share(static_cast<float>(++fade.ticks[lane]) * tick_s);
    d[lane] = share.displacement;
    v[lane] = share.velocity;
  }
  const float* velocity = start + std::size_t{words} * lane_count;
  for (std::size_t i = 0; i < std::size_t{words} * lane_count; i += lane_count) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      shown[i + lane] = displacement[i + lane] + (d[lane] * start[i + lane] + v[lane] * velocity[i + lane]);
    }
  }
}

}  // namespace mobil::inline v0_3
