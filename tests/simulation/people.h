#pragma once
// A crowd whose every member is another, by number; and what muscles share, made once for all tests of a process.

#include <cmath>

#include <mobil/body_composition.h>
#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/simulation.h>

namespace mobil {

/// `options`, with a library that all who ask here have in common. Not for tests of how what is shared is made,
/// counted, restored or refused.
inline SimulationOptions sharing(SimulationOptions options = {}) {
  static const Simulation library;
  options.library_of = &library;
  return options;
}

/// From the least to the most that a real body of that height weighs, kg: `part` 0 to 1.
inline float living_mass(float height_m, double part) {
  const auto [low, high] = living_mass_kg(static_cast<double>(height_m));
  return static_cast<float>(low + part * (high - low));
}

struct SamplePerson {
  BodyRequest body;
  GaitRequest gait;
};

/// SamplePerson `i` of a crowd: the same for ever, unlike the others, and able to walk as asked.
inline SamplePerson sample_person(int i) {
  // Golden-ratio steps through [0, 1), another stride for each quantity.
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
