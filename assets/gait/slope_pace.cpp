#include "assets/gait/slope_pace.h"

#include <algorithm>
#include <cmath>

#include "engine/exact_math.h"

namespace mobil::inline v0_3 {

float slope_speed(float asked_m_s, float steepness) {
  constexpr double easiest = -0.05, per_steepness = 3.5;
  constexpr float on_stairs_m_s = 0.6F;
  // Downhill is as easy as level ground, up to twice the easiest slope.
  const double beyond = std::max(std::fabs(double{steepness} - easiest) + easiest, 0.0);
  const auto part = static_cast<float>(exact::exp(-per_steepness * beyond));
  return std::max(asked_m_s * part, std::min(asked_m_s, on_stairs_m_s));
}

bool is_slowed(const Gait<float>& gait, const Footing<float>& footing) {
  return footing.level_speed_m_s > 0 && gait.revision == footing.looked_at;
}

LevelWalk level_walk(const Gait<float>& gait, const Footing<float>& footing) {
  if (is_slowed(gait, footing)) return {footing.level_speed_m_s, footing.level_length_m};
  return {gait.speed_m_s, gait.step_length_m};
}

}  // namespace mobil::inline v0_3
