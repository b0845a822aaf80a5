// One leg of sixteen walkers: where its hip is, how its foot rolls over heel and ball while it stands, and the angles
// of thigh and shank. Places relative to the foothold (the ground under the ankle of the flat foot): z forward, y up,
// out to the side, m; angles rad, from the downward vertical, forward positive. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_LEG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_LEG_INL_H_
#undef MOBIL_SYSTEMS_GAIT_LEG_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_LEG_INL_H_
#endif

#include "assets/body/anthropometry.h"
#include "components/gait.h"
#include "engine/wide_curve-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

constexpr float pi_f = 3.14159265F;
constexpr float degree_f = pi_f / 180.0F;
constexpr float gravity_f = 9.81F;

HWY_INLINE Wide ratio(double fraction_of_height, const Wide& height) {
  return wide(static_cast<float>(fraction_of_height)) * height;
}

struct Place {
  Wide out, up, forward;
};

HWY_INLINE Place operator+(const Place& a, const Place& b) {
  return {a.out + b.out, a.up + b.up, a.forward + b.forward};
}

struct LegSize {
  Wide thigh, shank, heel_back, ball_forward, ankle_height, toe_joint_height, hip_half_spacing;
};

HWY_INLINE LegSize leg_size(const Wide& height) {
  namespace f = fraction;
  return {ratio(f::thigh, height),           ratio(f::shank, height),        ratio(f::heel_back, height),
          ratio(f::ball_forward, height),    ratio(f::ankle_height, height), ratio(f::toe_joint_height, height),
          ratio(f::hip_half_spacing, height)};
}

/// Distance between hip and ankle at a knee flexion; a negative flexion stands for a leg that is longer than straight
/// by what the positive one makes it shorter.
HWY_NOINLINE inline Wide leg_reach(const LegSize& leg, const Wide& knee) {
  Wide s, c;
  sin_cos(knee, s, c);
  const Wide full = leg.thigh + leg.shank;
  const Wide bent = sqrt(max(full * full - 2.0F * leg.thigh * leg.shank * (1.0F - c), 0.0F));
  return full - copy_sign(full - bent, knee);
}

/// Knee flexion at a distance between hip and ankle, 0 where that is out of reach.
HWY_NOINLINE inline Wide knee_at(const LegSize& leg, const Wide& reach) {
  const Wide full = leg.thigh + leg.shank;
  const Wide short_of = max((full - reach) * (full + reach), 0.0F);  // 2 t s (1 − cos k)
  const Wide half_sine = sqrt(min(short_of / (4.0F * leg.thigh * leg.shank), 1.0F));
  return 2.0F * atan2(half_sine, sqrt(max(1.0F - half_sine * half_sine, 0.0F)));
}

/// What the manner blends to at a part of the step.
struct PelvisManner {
  Wide rotation, list, shift;
};

HWY_INLINE PelvisManner pelvis_manner(const Manner<Lanes<float>>& from, const Manner<Lanes<float>>& to,
                                      const Wide& part) {
  const Wide e = ease(part);
  return {mix(load(from.pelvis_rotation), load(to.pelvis_rotation), e),
          mix(load(from.pelvis_list), load(to.pelvis_list), e),
          mix(load(from.pelvis_shift_m), load(to.pelvis_shift_m), e)};
}

/// Place of a leg's hip from the middle of both, at a phase counted from this leg's own heel strike (0 to 2).
HWY_NOINLINE inline Place hip_offset(const LegSize& leg, const PelvisManner& pelvis, const Wide& phase) {
  namespace p = pelvis_phase;
  auto wave = [&](float at, float harmonic) {
    Wide s, c;
    sin_cos(pi_f * harmonic * (phase - at), s, c);
    return c;
  };
  Wide turned_s, turned_c, listed_s, listed_c;
  sin_cos(pelvis.rotation * wave(p::rotation, 1.0F), turned_s, turned_c);
  sin_cos(
      pelvis.list * (p::list_first * wave(p::list_first_phase, 1.0F) + p::list_third * wave(p::list_third_phase, 3.0F)),
      listed_s, listed_c);
  const Wide arm = leg.hip_half_spacing * listed_c;
  return {fma(arm, turned_c, pelvis.shift * wave(p::shift + 0.5F, 1.0F)), leg.hip_half_spacing * listed_s,
          arm * turned_s};
}

/// A planted foot's pitch, direction and distance from the walking line, and its ankle.
struct Footing {
  Wide half_width, sine, cosine;  // of toe-out
};

HWY_INLINE Footing footing(const Wide& half_width, const Wide& toe_out) {
  Footing f;
  f.half_width = half_width;
  sin_cos(toe_out, f.sine, f.cosine);
  return f;
}

/// The ankle of a foot turned by `pitch` about its heel (toes up) or its ball (heel up).
HWY_NOINLINE inline Place planted_ankle(const LegSize& leg, const Footing& foot, const Wide& pitch) {
  Wide s, c;
  sin_cos(pitch, s, c);
  const WideMask on_heel = pitch >= 0.0F;
  const Wide over = leg.ankle_height - leg.toe_joint_height;
  const Wide along =
      select(on_heel, leg.heel_back * (c - 1.0F) - leg.ankle_height * s, leg.ball_forward * (1.0F - c) - over * s);
  const Wide up =
      select(on_heel, leg.heel_back * s + leg.ankle_height * c, leg.toe_joint_height - leg.ball_forward * s + over * c);
  return {fma(foot.sine, along, foot.half_width), up, foot.cosine * along};
}

/// Velocity of that ankle for a pitch rate of 1.
HWY_NOINLINE inline Place planted_ankle_rate(const LegSize& leg, const Footing& foot, const Wide& pitch) {
  Wide s, c;
  sin_cos(pitch, s, c);
  const WideMask on_heel = pitch >= 0.0F;
  const Wide over = leg.ankle_height - leg.toe_joint_height;
  const Wide along = select(on_heel, -(leg.heel_back * s + leg.ankle_height * c), leg.ball_forward * s - over * c);
  const Wide up = select(on_heel, leg.heel_back * c - leg.ankle_height * s, -(leg.ball_forward * c + over * s));
  return {foot.sine * along, up, foot.cosine * along};
}

struct LegAngles {
  Wide thigh, shank, reach;
};

/// The knee forward; straight where the ankle is out of reach.
HWY_NOINLINE inline LegAngles leg_angles(const LegSize& leg, const Place& hip, const Place& ankle) {
  const Wide dx = ankle.out - hip.out, dy = hip.up - ankle.up, dz = ankle.forward - hip.forward;
  const Wide down = sqrt(fma(dx, dx, dy * dy));
  const Wide distance = sqrt(fma(dz, dz, down * down));
  const Wide direction = atan2(dz, down);
  const Wide reach = min(distance, (leg.thigh + leg.shank) * 0.999999F);
  const Wide near = (leg.thigh * leg.thigh - leg.shank * leg.shank + reach * reach) / (2.0F * reach);
  const Wide bulge = sqrt(max((leg.thigh - near) * (leg.thigh + near), 0.0F));
  return {direction + atan2(bulge, near), direction - atan2(bulge, reach - near), distance};
}

/// Pitch of a standing foot whose knee may stretch no further than `knee`: the heel rises as much as the hip's
/// distance asks for, rounded where it starts to, and not beyond the vertical.
HWY_NOINLINE inline Wide heel_rise(const LegSize& leg, const Footing& foot, const Place& hip, const Wide& knee) {
  const Wide dx = hip.out - foot.half_width, dy = hip.up - leg.ankle_height;
  const Wide flat_reach = sqrt(fma(dx, dx, fma(dy, dy, hip.forward * hip.forward)));
  const Wide limit = leg_reach(leg, knee);
  // The smaller of both, rounded with continuous curvature.
  const Wide within = 0.020F * (leg.thigh + leg.shank);
  const Wide h = max(1.0F - abs(limit - flat_reach) / within, 0.0F);
  const Wide wanted = min(limit, flat_reach) - h * h * h * within / 6.0F;
  // Circle about the toe joint, in the foot's vertical plane, against the circle about the hip.
  const Wide along = fma(hip.forward, foot.cosine, dx * foot.sine) - leg.ball_forward;
  const Wide aside = dx * foot.cosine - hip.forward * foot.sine;
  const Wide up = hip.up - leg.toe_joint_height;
  const Wide over = leg.ankle_height - leg.toe_joint_height;
  const Wide radius2 = fma(leg.ball_forward, leg.ball_forward, over * over);
  const Wide distance2 = fma(along, along, up * up);
  const Wide cosine = (radius2 + distance2 - (wanted * wanted - aside * aside)) / (2.0F * sqrt(radius2 * distance2));
  const Wide pitch = atan2(up, along) + acos(cosine) - atan2(over, -leg.ball_forward);
  return select(limit - flat_reach >= within, wide(0.0F), clamp(pitch, -0.5F * pi_f, 0.0F));
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
