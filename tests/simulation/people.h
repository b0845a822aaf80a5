#pragma once
// Different people by number, and a library of shared muscle data for all tests of a process.

#include <cmath>

#include <mobil/body_composition.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/simulation.h>

namespace mobil {

/// Returns `options` with a common library. It is unsuitable for tests of how shared data is made, counted, restored or
/// refused.
inline SimulationOptions sharing(SimulationOptions options = {}) {
  static const Simulation library;
  options.library_of = &library;
  return options;
}

/// Returns the mass of a real body of that height, kg: `part` 0 is the minimum, 1 the maximum.
inline float living_mass(float height_m, double part) {
  const auto [low, high] = living_mass_kg(static_cast<double>(height_m));
  return static_cast<float>(low + part * (high - low));
}

struct SamplePerson {
  BodyRequest body;
  GaitRequest gait;
};

/// Returns person `i` of a crowd: always the same, different from the others, and able to walk as requested.
inline SamplePerson sample_person(int i) {
  // Golden-ratio steps through [0, 1), with another stride for each quantity.
  const auto part = [i](int stride) {
    const double x = (i + 1) * stride * 0.6180339887498949;
    return static_cast<float>(x - std::floor(x));
  };
  SamplePerson p;
  p.body.height_m = 1.45F + 0.55F * part(1);
  p.body.mass_kg = (19.0F + 10.0F * part(2)) * p.body.height_m * p.body.height_m;
  p.body.biotype = {1 + 5 * part(3), 2 + 4 * part(5), 1 + 4 * part(7)};
  p.body.constitution = static_cast<Constitution>(i % 4);
  p.gait.speed_m_s = 1.0F + 0.6F * part(11);
  p.gait.style.pelvis_rotation_deg = 3 + 4 * part(13);
  p.gait.style.arm_back_deg = 10 + 15 * part(17);
  p.gait.style.swing_knee_deg = 58 + 8 * part(19);
  return p;
}

}  // namespace mobil
