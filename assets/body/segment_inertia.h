#pragma once
// Radii of gyration of the 48 segments.
//
// Source: de Leva, Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters, J. Biomech. 29, 1996, men of
// 1.741 m; the foot about its transverse axes from Dempster, tabulated by Winter (Biomechanics and Motor Control of
// Human Movement, table 4.1). De Leva divides the trunk into three parts; each vertebra is a slice of its own height
// with the transverse second moments of its part. Kneecap, collar bone, neck, toes, fingers and thumb have no tabulated
// values and are rods and cylinders of their size.

#include <array>
#include <cstddef>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Moments about each segment's centre of mass and its frame's axes (x to the left, y along or up, z forward), which
/// are its principal axes. They are of a segment of 1 kg in the unit body; multiply by the segment's mass and by the
/// square of its scale.
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
inline constexpr Part thigh{0.4222, 0.329, 0.149, 0.329};
inline constexpr Part shank{0.4340, 0.246, 0.102, 0.251};
inline constexpr Part upper_arm{0.2817, 0.269, 0.158, 0.285};
inline constexpr Part forearm{0.2689, 0.265, 0.121, 0.276};
inline constexpr double foot_along = 0.124, foot_length_m = 0.2581;
}  // namespace de_leva

/// Radius of gyration of a foot about its centre across, in parts of the length from ankle to ball (Winter).
inline constexpr double foot_gyration = 0.475;

constexpr UnitInertia make_unit_inertia() {
  using enum Segment;
  namespace f = fraction;
  const UnitBody& u = unit_body;
  UnitInertia inertia{};
  const auto square = [](double x) { return x * x; };
  const auto at = [](Segment s) { return index(s); };
  const auto radii = [&](Segment s, double x, double y, double z) { inertia[index(s)] = {x * x, y * y, z * z}; };

  // Second moments of mass across a part of the trunk; y is the contribution of the slice's own height.
  const auto slice = [&](Segment s, const de_leva::Part& part, double high) {
    const double unit = square(part.length_m / de_leva::stature_m);
    const double x = 0.5 * unit * (square(part.y) + square(part.z) - square(part.x));
    const double z = 0.5 * unit * (square(part.y) - square(part.z) + square(part.x)), y = high * high / 12;
    inertia[index(s)] = {y + z, x + z, x + y};
  };
  slice(pelvis, de_leva::lower_trunk, de_leva::lower_trunk.length_m / de_leva::stature_m);
  for (std::size_t i = at(L5); i <= at(T1); ++i) {
    const bool above_xiphoid = i >= at(T9);
    slice(static_cast<Segment>(i), above_xiphoid ? de_leva::upper_trunk : de_leva::middle_trunk, u.tip[i].y);
  }
  constexpr double neck_radius = 0.034;  // girth 0.38 m at 1.78 m
  for (std::size_t i = at(C7); i <= at(C1); ++i) {
    const double across = square(neck_radius) / 4 + square(u.tip[i].y) / 12;
    inertia[i] = {across, square(neck_radius) / 2, across};
  }
  constexpr double head_unit = de_leva::head_and_neck.length_m / de_leva::stature_m;
  radii(head, head_unit * de_leva::head_and_neck.x, head_unit * de_leva::head_and_neck.y,
        head_unit * de_leva::head_and_neck.z);

  for (std::size_t side = 0; side < 2; ++side) {
    const auto of = [&](Segment s) { return on_side(s, side); };
    /// Sets the inertia of `s` to that of both, 1 kg together, less that of another segment of known inertia.
    const auto rest = [&](Segment s, Segment other, const Vec3<double>& other_from_s, const Vec3<double>& both) {
      const double m = u.mass_share[index(s)], n = u.mass_share[index(other)], reduced = m * n;
      const Vec3<double> a = u.centre_of_mass[index(s)], b = u.centre_of_mass[index(other)], o = other_from_s;
      const Vec3<double> d{o.x + b.x - a.x, o.y + b.y - a.y, o.z + b.z - a.z};
      const Vec3<double>& i = inertia[index(other)];
      inertia[index(s)] = {(both.x - n * i.x - reduced * (d.y * d.y + d.z * d.z)) / m,
                           (both.y - n * i.y - reduced * (d.x * d.x + d.z * d.z)) / m,
                           (both.z - n * i.z - reduced * (d.x * d.x + d.y * d.y)) / m};
    };
    const auto part = [&](const de_leva::Part& p) {
      const double unit = p.length_m / de_leva::stature_m;
      return Vec3<double>{square(p.x * unit), square(p.y * unit), square(p.z * unit)};
    };

    // The kneecap, a disc 24 mm across and 20 mm thick at 1.80 m, is included in the tables' thigh.
    radii(of(patella_right), 0.0068, 0.0068, 0.0094);
    rest(of(thigh_right), of(patella_right), u.joint_offset[index(of(patella_right))], part(de_leva::thigh));
    inertia[index(of(shank_right))] = part(de_leva::shank);
    // The toes, a slab, are included in the tables' foot. Winter's foot ends at the head of the second metatarsal.
    radii(of(toes_right), 0.29 * f::toes_length, 0.36 * f::toes_length, 0.25 * f::toes_length);
    constexpr double foot_squared = f::ball_forward * f::ball_forward +
                                    (f::ankle_height - f::toe_joint_height) * (f::ankle_height - f::toe_joint_height);
    constexpr double across = foot_gyration * foot_gyration * foot_squared;
    constexpr double along = de_leva::foot_along * de_leva::foot_length_m / de_leva::stature_m;
    rest(of(foot_right), of(toes_right), u.joint_offset[index(of(toes_right))], {across, across, along * along});

    // The clavicle, with the muscle on it, is a rod from the breastbone to the shoulder.
    const double rod = square(u.tip[index(of(clavicle_right))].x) / 12;
    inertia[index(of(clavicle_right))] = {0.1 * rod, rod, rod};
    inertia[index(of(upper_arm_right))] = part(de_leva::upper_arm);
    inertia[index(of(forearm_right))] = part(de_leva::forearm);
    // Slabs of 85 and 80 mm across, 28 and 16 mm thick, and a rod, at 1.80 m. Palms face forward.
    const double palm = 0.5 * f::hand;
    const auto slab = [&](Segment s, double x, double y, double z) {
      inertia[index(s)] = {(y * y + z * z) / 12, (x * x + z * z) / 12, (x * x + y * y) / 12};
    };
    slab(of(hand_right), 0.047, palm, 0.0155);
    slab(of(fingers_right), 0.044, palm, 0.0089);
    slab(of(thumb_right), 0.011, 0.036, 0.011);
  }
  return inertia;
}

inline constexpr UnitInertia unit_inertia = make_unit_inertia();

}  // namespace mobil::inline v0_3
