#pragma once
// Costs of open ways: progress, an even walk, and foresight of approaching people.

#include "systems/avoidance/ways.h"

namespace mobil::inline v0_3 {

/// Sixteen ways onward: time until each begins, its start, speed and heading.
template <class F>
struct Onward {
  F duration_s, x_m, z_m, speed_m_s, heading_rad;
};

/// A person nearby: place, velocity, and the distance to keep.
struct Passer {
  float x_m, z_m, x_m_s, z_m_s, apart_m;
};

/// Writes the cost of ways that differ from the desired velocity, (m/s)²: velocity error, and facing elsewhere.
/// `toward` has length 1.
void cost_of_ways(const Onward<Lanes<float>>& ways, float speed_m_s, GroundPoint toward, Lanes<float>& cost);

/// Writes squared differences between velocities of that speed and heading and one velocity, (m/s)².
void off_velocity(const Lanes<float>& speed_m_s, const Lanes<float>& heading_rad, float x_m_s, float z_m_s,
                  Lanes<float>& cost);

/// Adds the cost of a later meeting: the inverse square of the time until then (Karamouzas, Skinner, Guy 2014).
void add_foresight(const Onward<Lanes<float>>& ways, const Passer& passer, Lanes<float>& cost);

}  // namespace mobil::inline v0_3
