#pragma once
// Moments of inertia of the 48 segments.
//
// Sources. Limbs about transverse axes: radii of gyration of Dempster, tabulated by Winter (Biomechanics and Motor
// Control of Human Movement, table 4.1). Limbs about their own length, trunk, head and hand: de Leva, Adjustments to
// Zatsiorsky-Seluyanov's segment inertia parameters, J. Biomech. 29, 1996, men of 1.741 m. De Leva divides the trunk
// into three parts; each vertebra is a slice of its own height with the transverse second moments of its part. Kneecap,
// collar bone, neck, toes, fingers and thumb have no tabulated values and are rods and cylinders of their size.

#include <array>
#include <cstddef>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Moments about each segment's centre of mass and its frame's axes (x to the left, y along or up, z forward), which
/// are its principal axes. They are of a body of height 1 m and mass 1 kg; multiply by mass · height².
using UnitInertia = std::array<Vec3<double>, segment_count>;
constexpr UnitInertia make_unit_inertia();

/// Returns the position of a segment's joint in the anatomical position, the body standing at x = z = 0, m.
Vec3<double> joint_centre_m(const Body& body, Segment segment);

namespace de_leva {
inline constexpr double stature_m = 1.741;
/// Radii of gyration about the axes x (transverse), y (longitudinal), z (sagittal) in parts of the length.
struct Part {
  double length_m, x, y, z;
};
inline constexpr Part upper_trunk{0.1707, 0.454, 0.659, 0.716};   // suprasternal notch to xiphoid process
inline constexpr Part middle_trunk{0.2155, 0.383, 0.468, 0.482};  // to the navel
inline constexpr Part lower_trunk{0.1457, 0.551, 0.587, 0.615};   // to the hip centres
inline constexpr Part whole_trunk{0.5319, 0.347, 0.191, 0.372};
inline constexpr Part head_and_neck{0.2033, 0.376, 0.312, 0.362};
inline constexpr Part hand{0.0862, 0.513, 0.401, 0.628};
inline constexpr double thigh_y = 0.149, shank_y = 0.102, upper_arm_y = 0.158, forearm_y = 0.121, foot_along = 0.124,
                        foot_length_m = 0.2581;
}  // namespace de_leva

/// Radii of gyration about the centre across the limb, in parts of the segment's length.
namespace winter {
inline constexpr double thigh = 0.323, shank = 0.302, foot = 0.475, upper_arm = 0.322, forearm = 0.303;
inline constexpr double foot_and_leg = 0.416, total_arm = 0.368, head_arms_trunk = 0.496;
}  // namespace winter

constexpr UnitInertia make_unit_inertia() {
  using enum Segment;
  namespace f = fraction;
  const UnitBody& u = unit_body;
  UnitInertia inertia{};
  const auto square = [](double x) { return x * x; };
  const auto at = [](Segment s) { return index(s); };
  const auto radii = [&](Segment s, double x, double y, double z) {
    const double m = u.mass_fraction[index(s)];
    inertia[index(s)] = {m * x * x, m * y * y, m * z * z};
  };

  // Second moments of mass across a part of the trunk; y is the contribution of the slice's own height.
  const auto slice = [&](Segment s, const de_leva::Part& part, double high) {
    const double unit = square(part.length_m / de_leva::stature_m), m = u.mass_fraction[index(s)];
    const double x = 0.5 * unit * (square(part.y) + square(part.z) - square(part.x));
    const double z = 0.5 * unit * (square(part.y) - square(part.z) + square(part.x)), y = high * high / 12;
    inertia[index(s)] = {m * (y + z), m * (x + z), m * (x + y)};
  };
  slice(pelvis, de_leva::lower_trunk, de_leva::lower_trunk.length_m / de_leva::stature_m);
  for (std::size_t i = at(L5); i <= at(T1); ++i) {
    const bool above_xiphoid = i >= at(T9);
    slice(static_cast<Segment>(i), above_xiphoid ? de_leva::upper_trunk : de_leva::middle_trunk, u.tip[i].y);
  }
  constexpr double neck_radius = 0.034;  // girth 0.38 m at 1.78 m
  for (std::size_t i = at(C7); i <= at(C1); ++i) {
    const double m = u.mass_fraction[i], across = m * (square(neck_radius) / 4 + square(u.tip[i].y) / 12);
    inertia[i] = {across, m * square(neck_radius) / 2, across};
  }
  constexpr double head_unit = de_leva::head_and_neck.length_m / de_leva::stature_m;
  radii(head, head_unit * de_leva::head_and_neck.x, head_unit * de_leva::head_and_neck.y,
        head_unit * de_leva::head_and_neck.z);

  for (std::size_t side = 0; side < 2; ++side) {
    const auto of = [&](Segment s) { return on_side(s, side); };
    /// Sets the inertia of `s` to that of both less that of another segment of known inertia.
    const auto rest = [&](Segment s, Segment other, const Vec3<double>& other_from_s, const Vec3<double>& both) {
      const double m = u.mass_fraction[index(s)], n = u.mass_fraction[index(other)], reduced = m * n / (m + n);
      const Vec3<double> a = u.centre_of_mass[index(s)], b = u.centre_of_mass[index(other)], o = other_from_s;
      const Vec3<double> d{o.x + b.x - a.x, o.y + b.y - a.y, o.z + b.z - a.z};
      const Vec3<double>& i = inertia[index(other)];
      inertia[index(s)] = {both.x - i.x - reduced * (d.y * d.y + d.z * d.z),
                           both.y - i.y - reduced * (d.x * d.x + d.z * d.z),
                           both.z - i.z - reduced * (d.x * d.x + d.y * d.y)};
    };
    const auto both = [&](double mass, double x, double y, double z) {
      return Vec3<double>{mass * x * x, mass * y * y, mass * z * z};
    };

    // The kneecap, a disc 24 mm across and 20 mm thick at 1.80 m, is included in the tables' thigh.
    radii(of(patella_right), 0.0068, 0.0068, 0.0094);
    rest(of(thigh_right), of(patella_right), u.joint_offset[index(of(patella_right))],
         both(0.100, winter::thigh * f::thigh, de_leva::thigh_y * f::thigh, winter::thigh * f::thigh));
    radii(of(shank_right), winter::shank * f::shank, de_leva::shank_y * f::shank, winter::shank * f::shank);
    // The toes, a slab, are included in the tables' foot. Winter's foot ends at the head of the second metatarsal.
    radii(of(toes_right), 0.29 * f::toes_length, 0.36 * f::toes_length, 0.25 * f::toes_length);
    constexpr double foot_squared = f::ball_forward * f::ball_forward +
                                    (f::ankle_height - f::toe_joint_height) * (f::ankle_height - f::toe_joint_height);
    constexpr double across = 0.0145 * winter::foot * winter::foot * foot_squared;
    constexpr double along = de_leva::foot_along * de_leva::foot_length_m / de_leva::stature_m;
    rest(of(foot_right), of(toes_right), u.joint_offset[index(of(toes_right))],
         {across, across, 0.0145 * along * along});

    // The clavicle, with the muscle on it, is a rod from the breastbone to the shoulder.
    const double rod = u.mass_fraction[index(of(clavicle_right))] * square(u.tip[index(of(clavicle_right))].x) / 12;
    inertia[index(of(clavicle_right))] = {0.1 * rod, rod, rod};
    radii(of(upper_arm_right), winter::upper_arm * f::upper_arm, de_leva::upper_arm_y * f::upper_arm,
          winter::upper_arm * f::upper_arm);
    radii(of(forearm_right), winter::forearm * f::forearm, de_leva::forearm_y * f::forearm,
          winter::forearm * f::forearm);
    // Slabs of 85 and 80 mm across, 28 and 16 mm thick, and a rod, at 1.80 m. Palms face forward.
    const double palm = 0.5 * f::hand;
    const auto slab = [&](Segment s, double x, double y, double z) {
      const double m = u.mass_fraction[index(s)] / 12;
      inertia[index(s)] = {m * (y * y + z * z), m * (x * x + z * z), m * (x * x + y * y)};
    };
    slab(of(hand_right), 0.047, palm, 0.0155);
    slab(of(fingers_right), 0.044, palm, 0.0089);
    slab(of(thumb_right), 0.011, 0.036, 0.011);
  }
  return inertia;
}

inline constexpr UnitInertia unit_inertia = make_unit_inertia();

}  // namespace mobil::inline v0_3
