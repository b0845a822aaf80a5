#pragma once
// Rods of a leg, and constants of the rules in systems/forces.

#include <cmath>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/lanes.h>
#include <mobil/components/segments.h>
#include "assets/body/segment_inertia.h"

namespace mobil::inline v0_3::forces {

inline constexpr float gravity = 9.81F;

/// A segment between two joints: centre of mass and radius of gyration about it (of the length, from the upper joint),
/// and its mass.
struct Rod {
  float centre, gyration;
  Lanes<float> BodySize<Lanes<float>>::*mass;
};

/// The kneecap is a part of the thigh.
inline constexpr Rod thigh = [] {
  using enum Segment;
  const double cap = unit_body.mass_share[index(patella_right)];
  const double centre = -(1 - cap) * unit_body.centre_of_mass[index(thigh_right)].y -
                        cap * unit_body.joint_offset[index(patella_right)].y;
  constexpr double gyration = de_leva::thigh.x * de_leva::thigh.length_m / de_leva::stature_m;
  return Rod{static_cast<float>(centre / fraction::thigh), static_cast<float>(gyration / fraction::thigh),
             &BodySize<Lanes<float>>::thigh_mass};
}();
inline constexpr Rod shank = {
    static_cast<float>(-unit_body.centre_of_mass[index(Segment::shank_right)].y / fraction::shank),
    static_cast<float>(de_leva::shank.x* de_leva::shank.length_m / de_leva::stature_m / fraction::shank),
    &BodySize<Lanes<float>>::shank_mass};
/// Centre of mass of the foot with its toes straight, from the ankle, in parts of the leg's scale.
inline constexpr Vec3<double> foot_centre = [] {
  using enum Segment;
  const UnitBody& u = unit_body;
  const double toes = u.mass_share[index(toes_right)];
  const auto &foot = u.centre_of_mass[index(foot_right)], &joint = u.joint_offset[index(toes_right)],
             &tip = u.centre_of_mass[index(toes_right)];
  return Vec3<double>{foot.x, std::lerp(foot.y, joint.y + tip.y, toes), std::lerp(foot.z, joint.z + tip.z, toes)};
}();
/// The foot, with the toes. Its length is from the ankle to the ball.
inline constexpr Rod foot = {0.0F, static_cast<float>(foot_gyration), &BodySize<Lanes<float>>::foot_mass};

/// Height above the ground of the point towards which the feet's forces lean, over the centre of mass's. The fitted
/// walk adds to it.
inline constexpr float pivot_height = 1.4F;

}  // namespace mobil::inline v0_3::forces
