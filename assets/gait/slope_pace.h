#pragma once
// How people slow down on slopes and stairs.

#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// How fast, m/s, who walks at `asked_m_s` on level ground goes where it rises by `steepness`, m per m of the way;
/// falls below 0. Tobler's hiking function (W. Tobler, Three presentations on geographical analysis and modeling, NCGIA
/// 93-1, 1993: exp(−3.5 |steepness + 0.05|)), beside level ground; but never faster than there. Nobody who walks no
/// faster than people do on stairs slows down: 0.6 m/s, horizontally (U. Weidmann, Transporttechnik der Fussgänger,
/// 1993: 0.61 up and 0.69 down).
float slope_speed(float asked_m_s, float steepness);

/// Whether a walker's gait is what slowing down has asked for.
bool is_slowed(const Gait<float>& gait, const Footing<float>& footing);
/// What somebody was asked to do on level ground: what their gait is, unless it is slowed.
struct LevelWalk {
  float speed_m_s, step_length_m;
};
LevelWalk level_walk(const Gait<float>& gait, const Footing<float>& footing);

}  // namespace mobil::inline v0_3
