#pragma once
// Speed scaling of people on slopes and stairs.

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Returns the speed, m/s, of a walker with `asked_m_s` on level ground where the way rises by `steepness`, m per m;
/// falls are below 0. It is Tobler's hiking function (W. Tobler, Three presentations on geographical analysis and
/// modeling, NCGIA 93-1, 1993: exp(−3.5 |steepness + 0.05|)), relative to level ground and never above it. Speeds up to
/// 0.6 m/s, that of people on stairs, are not scaled (U. Weidmann, Transporttechnik der Fussgänger, 1993: horizontally
/// 0.61 up and 0.69 down).
float slope_speed(float asked_m_s, float steepness);

/// True if a walker's gait is the result of speed scaling.
bool is_slowed(const Gait<float>& gait, const Footing<float>& footing);
/// Gait requested for level ground: the walker's own, unless it is scaled.
struct LevelWalk {
  float speed_m_s, step_length_m;
};
LevelWalk level_walk(const Gait<float>& gait, const Footing<float>& footing);

}  // namespace mobil::inline v0_3
