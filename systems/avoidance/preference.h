#pragma once
// What speaks for a way to go, of those that are clear: progress, an even walk, and foresight of who comes.

#include "systems/avoidance/ways.h"

namespace mobil::inline v0_3 {

/// Sixteen ways to go on: from where, after what time, how fast and toward where.
template <class F>
struct Onward {
  F duration_s, x_m, z_m, speed_m_s, heading_rad;
};

/// Somebody near by: where, how fast, and how far apart both should stay.
struct Passer {
  float x_m, z_m, x_m_s, z_m_s, apart_m;
};

/// What ways cost that are not as wished, (m/s)²: the velocity that is missed, and facing elsewhere. `toward`: of
/// length 1.
void cost_of_ways(const Onward<Lanes<float>>& ways, float speed_m_s, GroundPoint toward, Lanes<float>& cost);

/// How far velocities of that speed and heading are from one, squared.
void off_velocity(const Lanes<float>& speed_m_s, const Lanes<float>& heading_rad, float x_m_s, float z_m_s,
                  Lanes<float>& cost);

/// Adds what meeting somebody later costs: the inverse square of the time until then (Karamouzas, Skinner, Guy 2014).
void add_foresight(const Onward<Lanes<float>>& ways, const Passer& passer, Lanes<float>& cost);

}  // namespace mobil::inline v0_3
