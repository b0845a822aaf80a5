// Elementary rotations of sixteen lanes. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#undef MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#else
#define MOBIL_SYSTEMS_KINEMATICS_WIDE_INL_H_
#endif

#include "assets/body/body_scales.h"
#include "assets/body/segment_masses.h"
#include "assets/gait/step_curves-inl.h"
#include "engine/wide_geometry-inl.h"
#include "systems/gait/leg_size-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

HWY_INLINE WideVec scaled(const Vec3<float>& v, const Wide& by) {
  return {v.x * by, v.y * by, v.z * by};
}

/// Scales of sixteen people, in the order of LengthGroup.
struct WideScales {
  Wide of[length_groups];

  HWY_INLINE explicit WideScales(const BodySize<Lanes<float>>& size)
      : of{load(size.height_m),      load(size.leg_scale_m), hips_scale(load(size.height_m), load(size.leg_scale_m)),
           load(size.trunk_scale_m), load(size.height_m),    load(size.shoulders_scale_m),
           load(size.arm_scale_m)} {
    const Wide &height = of[0], off_leg = height - of[1], off_trunk = height - of[3];
    of[4] = height + (off_leg * head_per_leg + off_trunk * head_per_trunk);
  }
  HWY_INLINE const Wide& operator[](LengthGroup g) const { return of[static_cast<std::size_t>(g)]; }
};

/// Masses of sixteen people's groups of segments, in the order of MassGroup, parts of the body mass.
struct WideMasses {
  Wide of[mass_groups];

  HWY_INLINE explicit WideMasses(const BodySize<Lanes<float>>& size)
      : of{load(size.head_mass),      load(size.upper_trunk_mass), load(size.middle_trunk_mass),
           load(size.upper_arm_mass), load(size.forearm_mass),     load(size.thigh_mass),
           load(size.shank_mass),     load(size.foot_mass),        wide(0.0F)} {
    const Wide trunk = of[0] + of[1] + of[2], limbs = of[3] + of[4] + of[5] + of[6] + of[7];
    of[8] = 1.0F - trunk - 2.0F * limbs;
  }
  HWY_INLINE const Wide& operator[](MassGroup g) const { return of[static_cast<std::size_t>(g)]; }
};

/// Returns a vector of the unit body at each person's size.
HWY_INLINE WideVec scaled(const Vec3<float>& v, const WideScales& by, const AxisGroups& groups) {
  return {v.x * by[groups.x], v.y * by[groups.y], v.z * by[groups.z]};
}

HWY_INLINE WideQuat turn_x(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {s, wide(0.0F), wide(0.0F), c};
}
HWY_INLINE WideQuat turn_y(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {wide(0.0F), s, wide(0.0F), c};
}

/// Sine and cosine of half of a constant angle.
struct HalfAngle {
  float sine, cosine;
};
constexpr HalfAngle half_of(double angle) {
  return {cosine(0.5 * angle - 0.5 * 3.14159265358979324), cosine(0.5 * angle)};
}
HWY_INLINE WideQuat turn_x(const HalfAngle& half) {
  return {wide(half.sine), wide(0.0F), wide(0.0F), wide(half.cosine)};
}

/// Interpolates between two rotations that are less than a right angle apart.
MOBIL_WIDE_INLINE WideQuat part_way(const WideQuat& a, const WideQuat& b, const Wide& part) {
  const WideQuat m = {fma(part, b.x - a.x, a.x), fma(part, b.y - a.y, a.y), fma(part, b.z - a.z, a.z),
                      fma(part, b.w - a.w, a.w)};
  const Wide r = 1.0F / sqrt(fma(m.x, m.x, fma(m.y, m.y, fma(m.z, m.z, m.w * m.w))));
  return {m.x * r, m.y * r, m.z * r, m.w * r};
}
HWY_INLINE WideQuat turn_z(const Wide& angle) {
  Wide s, c;
  sin_cos(angle * wide(0.5F), s, c);
  return {wide(0.0F), wide(0.0F), s, c};
}

/// Returns a rotation about y, within it about z, within that about x.
MOBIL_WIDE_INLINE WideQuat turn_yzx(const Wide& y, const Wide& z, const Wide& x) {
  return turn_y(y) * (turn_z(z) * turn_x(x));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
