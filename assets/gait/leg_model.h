#pragma once
// Masses of a leg, and constants of the rules in systems/forces.

#include <mobil/components/segments.h>
#include "assets/body/fat_distribution.h"

namespace mobil::inline v0_3::forces {

inline constexpr float gravity = 9.81F;

/// A segment between two joints: mass (of the body's), centre of mass and radius of gyration about it (of the length,
/// from the upper joint).
struct Rod {
  float mass, centre, gyration;
  float mass_per_extra_fat;
};

constexpr double mass_of(Segment s) {
  return unit_body.mass_fraction[index(s)];
}
constexpr float extra_mass_of(Segment s) {
  return static_cast<float>(mass_per_extra_fat(index(s)));
}

/// Radii of gyration: Winter, Biomechanics and Motor Control of Human Movement, table of Dempster's segments.
inline constexpr Rod thigh = [] {
  using enum Segment;
  const double cap = -unit_body.joint_offset[index(patella_right)].y;
  const double mass = mass_of(thigh_right) + mass_of(patella_right);
  const double centre =
      -mass_of(thigh_right) * unit_body.centre_of_mass[index(thigh_right)].y + mass_of(patella_right) * cap;
  return Rod{static_cast<float>(mass), static_cast<float>(centre / mass / fraction::thigh), 0.323F,
             extra_mass_of(thigh_right) + extra_mass_of(patella_right)};
}();
inline constexpr Rod shank = {
    static_cast<float>(mass_of(Segment::shank_right)),
    static_cast<float>(-unit_body.centre_of_mass[index(Segment::shank_right)].y / fraction::shank), 0.302F,
    extra_mass_of(Segment::shank_right)};
/// The foot's centre of mass is tracked as a separate point.
inline constexpr Rod foot = {static_cast<float>(mass_of(Segment::foot_right) + mass_of(Segment::toes_right)), 0.0F,
                             0.475F, extra_mass_of(Segment::foot_right) + extra_mass_of(Segment::toes_right)};

/// Height above the ground of the point towards which the feet's forces lean, over the centre of mass's. The fitted
/// walk adds to it.
inline constexpr float pivot_height = 1.4F;

}  // namespace mobil::inline v0_3::forces
