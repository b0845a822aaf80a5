// Feet and hips over ground that is not level. Include it as engine/wide-inl.h describes.

#if defined(MOBIL_ASSETS_GAIT_UNEVEN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_UNEVEN_INL_H_
#undef MOBIL_ASSETS_GAIT_UNEVEN_INL_H_
#else
#define MOBIL_ASSETS_GAIT_UNEVEN_INL_H_
#endif

#include <mobil/components/footing.h>
#include "assets/gait/on_line-inl.h"
#include "assets/gait/rise_table.h"
#include "engine/wide_geometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// The ground about a foothold: its height above the stance foothold, and its rise to the left of the stance foot's
/// heading and along it, m per m. `moved_left` and `moved_along` are the foothold's displacement.
struct Slope {
  Wide height, left, along;
  Wide moved_left, moved_along;
};

HWY_INLINE Slope part_way(const Slope& a, const Slope& b, const Wide& part) {
  return {mix(a.height, b.height, part), mix(a.left, b.left, part), mix(a.along, b.along, part),
          mix(a.moved_left, b.moved_left, part), mix(a.moved_along, b.moved_along, part)};
}

HWY_INLINE Slope slope_at(const Footing<Lanes<float>>& footing, FootholdOf which, const Wide& sine,
                          const Wide& cosine) {
  const auto i = index(which), stance = index(FootholdOf::stance);
  const Wide x = load(footing.rise_x[i]), z = load(footing.rise_z[i]);
  const Wide moved_x = load(footing.moved_x_m[i]), moved_z = load(footing.moved_z_m[i]);
  return {load(footing.height_m[i]) - load(footing.height_m[stance]), fnma(z, sine, x * cosine),
          fma(x, sine, z * cosine), fnma(moved_z, sine, moved_x * cosine), fma(moved_x, sine, moved_z * cosine)};
}

/// Returns the shortest rotation from the vertical to the normal of such ground.
HWY_INLINE WideQuat tilt_of(const Wide& left, const Wide& along) {
  const Wide up = 1.0F / sqrt(fma(left, left, fma(along, along, wide(1.0F))));
  const Wide w = 1.0F + up, x = -along * up, z = left * up;
  const Wide r = 1.0F / sqrt(fma(w, w, fma(x, x, z * z)));
  return {x * r, wide(0.0F), z * r, w * r};
}

/// The ground of a step's three footholds.
struct Slopes {
  Slope leaving, stance, landing;
};

HWY_INLINE Slopes slopes_of(const Footing<Lanes<float>>& footing, const Wide& heading) {
  Wide s, c;
  sin_cos(heading, s, c);
  return {slope_at(footing, FootholdOf::leaving, s, c), slope_at(footing, FootholdOf::stance, s, c),
          slope_at(footing, FootholdOf::landing, s, c)};
}

/// Differences of a step over a rise from one on level ground: `rise_table::numbers` times a part that grows with the
/// steepness at its strike.
struct RiseParameters {
  Wide of[rise_table::count];
  Wide rate;  // of the hips' height, by phase
  HWY_INLINE Wide operator[](rise_table::Number n) const { return of[n]; }
};

/// Returns the parameters between two footholds whose ground rises by `along`, m per m, on average. A walker steps off
/// an edge from the forefoot however long the step, because the ankle does not bend further.
HWY_INLINE RiseParameters rise_parameters(const Wide& rise, const Wide& along, const Wide& length, const Wide& height) {
  using namespace rise_table;
  const Wide one = wide(1.0F);
  const Wide steep = min(abs(rise) / (full * max(length, shortest_h * height)), one);
  const Wide part = smooth((steep - gentle) * (1.0F / (stairs - gentle)));
  const WideMask upward = rise > 0.0F;
  const auto towards = [&](const Wide& by, std::size_t n)
                           HWY_ATTR { return by * select(upward, wide(numbers[0][n]), wide(numbers[1][n])); };
  RiseParameters m;
  for (std::size_t n = 0; n < count; ++n) m.of[n] = towards(n == trunk_lean ? steep : part, n);
  const Wide drop = fma(along, length, -rise) / (edge_h * height);
  const Wide further = max(fma(length / height, wide(edge_further), wide(1.0F - edge_further * stairs_h)), one);
  m.of[heel_up_more] = select(upward, m.of[heel_up_more], towards(max(part, further * smooth(drop)), heel_up_more));
  m.rate = rise * select(upward, mix(wide(gentle_rate[0]), wide(rate[0]), part),
                         mix(wide(gentle_rate[1]), wide(rate[1]), part));
  return m;
}

/// Parameters of two strikes, mixed at a part of the way from one to the other.
struct MixedParameters {
  const RiseParameters &from, &to;
  Wide part;
  HWY_INLINE Wide operator[](rise_table::Number n) const { return mix(from[n], to[n], part); }
};

/// Returns how far a heel has risen more than on level ground, from its beginning to toe-off. `double_support` is that
/// after the other foot's strike, of the cycle.
HWY_INLINE Wide heel_up(const Wide& cycle, const Wide& double_support) {
  const Wide off = 0.5F + double_support;
  return smooth((cycle - rise_table::heel_up_from) / (off - rise_table::heel_up_from));
}

/// A leg at a strike: horizontal way from its foothold to the hip, pitch of the foot on level ground and here, and rise
/// of the ground along it.
struct StrikeLeg {
  Wide hip_ahead, level_pitch, pitch, along;
};

/// Returns the height over its foothold, relative to level ground, that a leg permits hips that are moved by `ahead`.
HWY_NOINLINE inline Wide reaches_higher(const StrikeLeg& leg, const Wide& ahead, const Wide& height) {
  const Wide zero = wide(0.0F), full = static_cast<float>(fraction::thigh + fraction::shank) * height;
  const auto reach = [&](const Wide& pitch, const Wide& along, const Wide& hip) HWY_ATTR {
    const FootMotion foot = plant(height, pitch, zero, zero);
    const Wide across = hip - foot.ankle_forward + along * foot.ankle_up;
    return fma(along, foot.ankle_forward, foot.ankle_up) +
           sqrt(max(full * full - across * across, 0.01F * full * full));
  };
  return reach(leg.pitch, leg.along, leg.hip_ahead + ahead) - reach(leg.level_pitch, zero, leg.hip_ahead);
}

/// Returns the hips' height above the step's stance foothold at a strike, relative to level ground. Above the lower
/// foot it is as on level ground, and at most both legs' reach.
HWY_NOINLINE inline Wide hips_at_strike(const HeelStrike<Lanes<float>>& strike, const Slope& behind, const Slope& ahead,
                                        const RiseParameters& posture, const Wide& height) {
  using namespace rise_table;
  const OneShape of{strike.shape};
  Wide hips = of(step_shape::hips_forward, 0);
  for (std::size_t k = 1; k <= 4; ++k) hips = hips + of(step_shape::hips_forward, k);
  const Wide lands = of(step_shape::strike, 0), half = wide(0.5F);
  const Wide rise = usual_rise + of(step_shape::times, 1), double_support = load(strike.double_support);
  const Wide leaves = heel_rise(of, (half - rise) / (half + double_support - rise));
  const Wide nearer = 0.5F * (behind.moved_along - ahead.moved_along);  // the hips move half as far as both feet
  const StrikeLeg leading = {hips, lands, fnma(posture[strike_less], lands, lands - posture[toes_first]), ahead.along};
  const StrikeLeg trailing = {hips + load(strike.length_m), leaves,
                              fnma(posture[heel_up_more], heel_up(half, double_support), leaves), behind.along};
  const Wide moved = posture[hips_ahead] * height;
  return min(fma(posture[hips_up], height, min(behind.height, ahead.height)),
             min(ahead.height + reaches_higher(leading, moved + nearer, height),
                 behind.height + reaches_higher(trailing, moved - nearer, height)));
}

/// The ground of a step, the parameters of the rises before and after its stance foothold, and the hips' height at its
/// two strikes.
struct Uneven {
  Slopes slopes;
  RiseParameters from, to;
  Wide hips_from, hips_to;
};

HWY_NOINLINE inline Uneven uneven_of(const StepPlan<Lanes<float>>& plan, const Footing<Lanes<float>>& footing,
                                     const Wide& heading, const Wide& turn, const Wide& height) {
  Uneven u;
  u.slopes = slopes_of(footing, heading);
  const auto& [leaving, stance, landing] = u.slopes;
  // Both steps see a strike along the heading at its leading foothold.
  const Slopes there = slopes_of(footing, heading + turn);
  // A standing walker uses level-ground posture.
  const Wide zero = wide(0.0F);
  const auto level = [&](const HeelStrike<Lanes<float>>& strike, const Wide& value)
                         HWY_ATTR { return select(stands(strike), zero, value); };
  u.from = rise_parameters(level(plan.from, -leaving.height), level(plan.from, 0.5F * (leaving.along + stance.along)),
                           load(plan.length_before_m), height);
  u.to =
      rise_parameters(level(plan.to, landing.height), level(plan.to, 0.5F * (there.stance.along + there.landing.along)),
                      load(plan.step_length_m), height);
  u.hips_from = hips_at_strike(plan.from, leaving, stance, u.from, height);
  // A standing walker moves no foot.
  u.hips_to = select(load(plan.landing) > 0.0F, hips_at_strike(plan.to, there.stance, there.landing, u.to, height),
                     u.hips_from);
  return u;
}

/// Returns the distance over which straightening legs hold the hips back on uneven ground, more than on level ground.
HWY_INLINE Wide gentler(const Uneven& uneven, const Wide& eased, const Wide& height) {
  constexpr float part_of_rise = 0.15F, max_h = 0.012F;
  return min(part_of_rise * mix(abs(uneven.slopes.leaving.height), abs(uneven.slopes.landing.height), eased),
             max_h * height);
}

/// Returns a bump with a value and a slant.
HWY_INLINE Wide slanted_bump(const MixedParameters& m, rise_table::Number value, rise_table::Number slant,
                             const Wide& u) {
  return bump(u) * fma(2.0F * u - 1.0F, m[slant], m[value]);
}

/// Position of the hips relative to level ground: up over the stance foothold, and ahead. At a strike their height
/// follows only from that of both feet, so it is equal on either side of it.
struct HipsOver {
  Wide up, ahead, lean;
};

HWY_NOINLINE inline HipsOver hips_over(const StepPlan<Lanes<float>>& plan, const Uneven& uneven, const Wide& height,
                                       const Wide& phase) {
  using namespace rise_table;
  const Wide zero = wide(0.0F), from = uneven.hips_from, to = uneven.hips_to;
  const Wide rate_from = uneven.from.rate, rate_to = uneven.to.rate;
  const Wide r = to - from - rate_from, s = rate_to - rate_from, p = phase;
  const Wide even = fma(
      p, fma(p * p, fma(p, fma(p, 6.0F * r - 3.0F * s, 7.0F * s - 15.0F * r), 10.0F * r - 4.0F * s), rate_from), from);
  const MixedParameters mixed{uneven.from, uneven.to, smooth(p)};
  const Wide walks = select(load(plan.landing) > 0.0F, wide(1.0F), zero);
  const Wide over = vault * mix(abs(uneven.slopes.leaving.height), abs(uneven.slopes.landing.height), mixed.part);
  return {fma(walks, fma(slanted_bump(mixed, hips_up_middle, hips_up_late, p), height, bump(p) * over), even),
          height * (mixed[hips_ahead] + slanted_bump(mixed, hips_ahead_middle, hips_ahead_late, p)), mixed[trunk_lean]};
}

/// Returns the way of the hips with the footholds: at a strike, the mean of both feet's.
HWY_INLINE Ground hips_moved(const Slopes& slopes, const Wide& eased) {
  const Slope hips = part_way(part_way(slopes.leaving, slopes.stance, wide(0.5F)),
                              part_way(slopes.stance, slopes.landing, wide(0.5F)), eased);
  return {hips.moved_left, hips.moved_along};
}

/// Moves the ankle of a foot on the ground to another pitch.
HWY_NOINLINE inline void pitch_planted(const Wide& height, const Wide& pitch, FootMotion& foot) {
  const FootMotion was = plant(height, foot.pitch, foot.toe_out, wide(0.0F)),
                   is = plant(height, pitch, foot.toe_out, wide(0.0F));
  foot.pitch = pitch;
  foot.toes = foot.toes + is.toes - was.toes;
  foot.ankle_up = foot.ankle_up + is.ankle_up - was.ankle_up;
  foot.ankle_out = foot.ankle_out + is.ankle_out - was.ankle_out;
  foot.ankle_forward = foot.ankle_forward + is.ankle_forward - was.ankle_forward;
}

/// An ankle over its foothold at that pitch, rolled over its heel or over its toes. Pitches below `rounded` are blended
/// between the two, where planted_ankle has a corner.
struct RolledAnkle {
  Wide along, up;
};
HWY_NOINLINE inline RolledAnkle rolled_ankle(const Wide& height, const Wide& pitch, const Wide& rounded) {
  using namespace unit_foot;
  Wide s, c, q_s, q_c;
  sin_cos(pitch, s, c);
  sin_cos(toe_pitch(max(-pitch, 0.0F)).value, q_s, q_c);
  const Wide on_heel = smooth(fma(pitch, 0.5F / rounded, wide(0.5F)));
  const Wide joint_y = fma(wide(toes), q_s, joint * q_c), joint_z = fma(wide(toes), q_c, -joint * q_s);
  const Wide ankle_y = fma(wide(-ball), s, over_joint * c), ankle_z = fma(wide(ball), c, over_joint * s);
  return {
      height * mix((ball + toes) - joint_z - ankle_z, fma(wide(back), c, -over_rim * s) - back - rim * pitch, on_heel),
      height * mix(joint_y + ankle_y, fma(wide(back), s, over_rim * c) + rim, on_heel)};
}

/// Moves the ankle of a foot in the air to another pitch, by a part of it; exact where the corner is not rounded.
HWY_NOINLINE inline void pitch_in_air(const Wide& height, const Wide& pitch, const Wide& part, const Wide& rounded,
                                      FootMotion& foot) {
  const RolledAnkle was = rolled_ankle(height, foot.pitch, rounded), is = rolled_ankle(height, pitch, rounded);
  const Wide toes_before = max(-foot.pitch, 0.0F) - toe_pitch(max(-foot.pitch, 0.0F)).value;
  const Wide toes_after = max(-pitch, 0.0F) - toe_pitch(max(-pitch, 0.0F)).value;
  Wide s, c;
  sin_cos(foot.toe_out, s, c);
  foot.pitch = pitch;
  foot.toes = fma(part, toes_after - toes_before, foot.toes);
  foot.ankle_up = fma(part, is.up - was.up, foot.ankle_up);
  const Wide along = part * (is.along - was.along);
  foot.ankle_out = fma(s, along, foot.ankle_out);
  foot.ankle_forward = fma(c, along, foot.ankle_forward);
}

/// Returns the height of the foot in the air above the straight line from one foothold to the next.
HWY_INLINE Wide lift_now(const Footing<Lanes<float>>& footing, const Wide& part) {
  const auto hill = [&](float top) HWY_ATTR {
    return smooth(part * (1.0F / top)) * (1.0F - smooth((part - top) * (1.0F / (1.0F - top))));
  };
  return fma(load(footing.lift_early_m), hill(swing_lift::early), load(footing.lift_late_m) * hill(swing_lift::late));
}

/// Adapts both feet to another height. A foot that comes to it lands flat or, on the way down, toes first; one that
/// goes down leaves the ground with its heel further up.
HWY_NOINLINE inline void step_otherwise(const StepPlan<Lanes<float>>& plan, const Footing<Lanes<float>>& footing,
                                        const MixedShape& of, const Uneven& uneven, const Wide& height,
                                        const Wide& phase, FootMotion& stance, FootMotion& other) {
  using namespace rise_table;
  const OneShape from{plan.from.shape};
  const Wide cycle = 0.5F * phase, one = wide(1.0F), zero = wide(0.0F);
  const WideMask walks = load(plan.landing) > 0.0F;
  const Wide ends = mix(load(plan.from.double_support), load(plan.to.double_support), of.part);
  const Wide flat = usual_flat + from(step_shape::times, 0);
  const Wide heel = falling(from, step_shape::strike, cycle / flat);
  // On the way up the pitch must not pass through level.
  const Wide falls = select(uneven.slopes.leaving.height < 0.0F, flat, wide(toes_first_part));
  const Wide u = min(cycle / falls, one), left = 1.0F - u;
  const Wide toes = left * left * left * fma(u, fma(u, wide(6.0F), wide(3.0F)), one);
  const Wide rising = select(walks, uneven.to[heel_up_more] * heel_up(cycle, ends), zero);
  pitch_planted(
      height, fnma(uneven.from[strike_less], heel, fnma(uneven.from[toes_first], toes, stance.pitch - rising)), stance);

  const Wide part = other.part, lands = smooth(part);
  const Wide risen = heel_up(0.5F + cycle, 0.5F * load(plan.double_support));
  const Wide lifted = fnma(uneven.from[heel_up_more], risen * (1.0F - lands), other.pitch);
  // The landing foot's corner equals the one on the ground only at the strike.
  const Wide rounded = fma(smooth(2.0F * part - 1.0F), wide(-0.199F), wide(0.2F));
  pitch_in_air(height, lifted, 1.0F - smooth(2.0F * part), wide(1e-3F), other);
  const MixedParameters mixed{uneven.from, uneven.to, lands};
  const Wide in_air = max(bump(part), 0.0F) * height;
  pitch_in_air(height,
               fnma(lands * uneven.to[strike_less], other.pitch, fnma(lands, uneven.to[toes_first], other.pitch)) +
                   slanted_bump(mixed, swing_pitch, swing_pitch_late, part),
               lands, rounded, other);
  const Wide x = 2.0F * part - 1.0F;
  other.ankle_forward = fma(in_air, fma(x, mixed[swing_ahead_late], mixed[swing_ahead]), other.ankle_forward);
  other.ankle_up = other.ankle_up + lift_now(footing, part);
  other.ankle_up = select(phase >= load(plan.double_support), above_ground(other, height), other.ankle_up);
}

/// Returns the place of the other foot's ankle if laid flat, part of the way from its last foothold to its next one.
HWY_NOINLINE inline Ground flat_other(const StepPlan<Lanes<float>>& plan, const Line& line, const Wide& swung,
                                      const Wide& out) {
  Wide before_s, before_c, ahead_s, ahead_c;
  sin_cos(-line.turned_before, before_s, before_c);
  sin_cos(line.turn, ahead_s, ahead_c);
  const Wide zero = wide(0.0F);
  Ground from = turned(fma(out, load(plan.trailing_half_width_m), line.shift_before), zero, before_s, before_c),
         to = turned(fma(out, load(plan.to.half_width_m), line.shift_next), zero, ahead_s, ahead_c);
  from = {fnma(line.from.length_m, line.from_s, from.left), fnma(line.from.length_m, line.from_c, from.forward)};
  to = {fma(line.to.length_m, line.to_s, to.left), fma(line.to.length_m, line.to_c, to.forward)};
  return part_way(from, to, swung);
}

/// Moves a foot from level ground to such ground. `flat` is the place of its ankle if laid flat.
HWY_NOINLINE inline void put_on(const Slope& slope, const Ground& flat, FootMotion& foot, Foothold& at) {
  const WideVec off = rotate(tilt_of(slope.left, slope.along),
                             {at.ankle.left - flat.left, foot.ankle_up, at.ankle.forward - flat.forward});
  at.ankle = {flat.left + slope.moved_left + off.x, flat.forward + slope.moved_along + off.z};
  foot.ankle_up = slope.height + off.y;
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
