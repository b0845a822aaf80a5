#pragma once
// What a leg weighs, and the numbers of the rules in systems/forces/forces.h.

#include "assets/body/anthropometry.h"
#include "components/segments.h"

namespace mobil::forces {

inline constexpr float gravity = 9.81F;

/// A segment between two joints: mass (of the body's), centre of mass and radius of gyration about it (of the length,
/// from the upper joint).
struct Rod {
  float mass, centre, gyration;
};

constexpr double mass_of(Segment s) {
  return unit_body.mass_fraction[index(s)];
}

/// Radii of gyration: Winter, Biomechanics and Motor Control of Human Movement, table of Dempster's segments.
inline constexpr Rod thigh = [] {
  using enum Segment;
  const double cap = -unit_body.joint_offset[index(patella_right)].y;
  const double mass = mass_of(thigh_right) + mass_of(patella_right);
  const double centre =
      -mass_of(thigh_right) * unit_body.centre_of_mass[index(thigh_right)].y + mass_of(patella_right) * cap;
  return Rod{static_cast<float>(mass), static_cast<float>(centre / mass / fraction::thigh), 0.323F};
}();
inline constexpr Rod shank = {
    static_cast<float>(mass_of(Segment::shank_right)),
    static_cast<float>(-unit_body.centre_of_mass[index(Segment::shank_right)].y / fraction::shank), 0.302F};
/// Its centre of mass is a tracked point of its own.
inline constexpr Rod foot = {static_cast<float>(mass_of(Segment::foot_right) + mass_of(Segment::toes_right)), 0.0F,
                             0.475F};
inline constexpr float toes_of_foot = static_cast<float>(mass_of(Segment::toes_right)) / foot.mass;

/// Share of the vertical force taken over: 1 − (1 − u)²(1 + load_curve·u).
inline constexpr float load_curve = 1.3F;
/// Height over the ground of the point that the feet's forces lean toward, of the centre of mass's.
inline constexpr float pivot_height = 1.4F;
/// Centre of pressure ahead of the ankle, foot flat, in body heights: rocker_centre + rocker_reach · x/√(1 + x²),
/// x = (slope of the leg − rocker_slope)/rocker_range.
inline constexpr float rocker_centre = 0.037F, rocker_reach = 0.052F, rocker_slope = -0.02F, rocker_range = 0.19F;
/// Its further travel as the heel rises, of the heel's height.
inline constexpr float toe_travel = 0.10F;
/// Height of heel and ball over one another at which the upper end bears nothing, in body heights: the pads are soft
/// and round.
inline constexpr float heel_pad = 0.020F, ball_pad = 0.022F;
/// To each side of the foot's line, in body heights.
inline constexpr float half_sole_width = 0.025F;
/// v²/(g·height) at which rest and motion count alike: 0.15 m/s at 1.75 m.
inline constexpr float rest_froude = 0.0013F;

}  // namespace mobil::forces
