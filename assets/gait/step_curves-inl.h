// Curves of a step's shape (mobil/components/step_shape.h), of sixteen walkers. Include it as engine/wide-inl.h
// describes.

#if defined(MOBIL_ASSETS_GAIT_STEP_CURVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_GAIT_STEP_CURVES_INL_H_
#undef MOBIL_ASSETS_GAIT_STEP_CURVES_INL_H_
#else
#define MOBIL_ASSETS_GAIT_STEP_CURVES_INL_H_
#endif

#include <mobil/anthropometry.h>
#include <mobil/components/step_plan.h>
#include "engine/wide_curve-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Foot flat and heel rise in the usual walk, of the cycle from a leg's own heel strike. `pad_part` is the part of the
/// cycle in which the heel's pad yields.
constexpr float usual_flat = 0.09F, usual_rise = 0.30F, pad_part = 0.05F;

HWY_INLINE WideMask stands(const HeelStrike<Lanes<float>>& strike) {
  return load(strike.speed_m_s) <= 0.0F;
}

HWY_INLINE WideMask stands_still(const StepPlan<Lanes<float>>& plan) {
  return stands(plan.from) & stands(plan.to);
}

/// The foot of a body of height 1 m: distances ahead of and behind the ankle, radius of the heel's rim, height of the
/// toes' joint, and of the ankle above each.
namespace unit_foot {
constexpr auto back = static_cast<float>(fraction::heel_back), ball = static_cast<float>(fraction::ball_forward);
constexpr auto toes = static_cast<float>(fraction::toes_length), rim = static_cast<float>(fraction::heel_radius);
constexpr auto joint = static_cast<float>(fraction::toe_joint_height);
constexpr float over_rim = static_cast<float>(fraction::ankle_height) - rim;
constexpr float over_joint = static_cast<float>(fraction::ankle_height) - joint;
}  // namespace unit_foot

/// Outward distance of a standing person's ankle from the hip, of the height.
constexpr float ankle_outward = 0.022F;

/// Mixed numbers of two strikes' shapes.
struct MixedShape {
  const Lanes<float>*from, *to;
  Wide part;
  HWY_INLINE Wide operator()(const ShapePart& p, std::size_t i) const {
    return mix(load(from[p.first + i]), load(to[p.first + i]), part);
  }
};
/// Numbers of one shape.
struct OneShape {
  const Lanes<float>* numbers;
  HWY_INLINE Wide operator()(const ShapePart& p, std::size_t i) const { return load(numbers[p.first + i]); }
};

/// cos and sin of k π p, p the phase of the step.
struct StepWaves {
  Wide cosine[9], sine[9];
};

HWY_NOINLINE inline StepWaves step_waves(const Wide& phase) {
  StepWaves w;
  w.cosine[0] = wide(1.0F);
  w.sine[0] = wide(0.0F);
  sin_cos(3.14159265F * phase, w.sine[1], w.cosine[1]);
  for (std::size_t k = 2; k < 9; ++k) {
    const std::size_t a = k / 2, b = k - a;
    w.cosine[k] = fma(w.cosine[a], w.cosine[b], -(w.sine[a] * w.sine[b]));
    w.sine[k] = fma(w.sine[a], w.cosine[b], w.cosine[a] * w.sine[b]);
  }
  return w;
}

/// Returns `count` harmonics of the step, about a value.
template <class Shape>
HWY_INLINE Wide harmonics_about(const Wide& value, const Shape& of, const ShapePart& part, std::size_t count,
                                const StepWaves& w) {
  Wide sum = value;
  for (std::size_t k = 1; k <= count; ++k)
    sum = fma(of(part, k), w.cosine[2 * k], fma(of(part, count + k), w.sine[2 * k], sum));
  return sum;
}

/// Returns a mean and `count` harmonics of the step.
template <class Shape>
HWY_INLINE Wide harmonics(const Shape& of, const ShapePart& part, std::size_t count, const StepWaves& w) {
  return harmonics_about(of(part, 0), of, part, count, w);
}

/// Returns the hips' way to the left while the right foot stands, to the right while the left one does.
template <class Shape>
HWY_INLINE Wide hips_aside(const Shape& of, const StepWaves& w) {
  const ShapePart& p = step_shape::aside;
  return fma(of(p, 0), w.cosine[1], fma(of(p, 1), w.cosine[3], fma(of(p, 2), w.sine[1], of(p, 3) * w.sine[3])));
}

/// Returns (1 − u)³ times a polynomial that starts with the part's first number and no slope of its own; 0 from u = 1.
template <class Shape>
HWY_INLINE Wide falling(const Shape& of, const ShapePart& part, const Wide& u) {
  const Wide left = max(1.0F - u, 0.0F);
  Wide tail = wide(0.0F);
  for (std::size_t i = part.count - 1; i > 0; --i) tail = u * (of(part, i) + tail);
  return left * left * left * fma(of(part, 0), fma(u, fma(u, wide(6.0F), wide(3.0F)), wide(1.0F)), tail);
}

/// Returns the pitch from heel rise (u = 0) to toe-off (u = 1): heel up, negative.
template <class Shape>
HWY_INLINE Wide heel_rise(const Shape& of, const Wide& u) {
  const Wide v = clamp(u, 0.0F, 1.0F);
  Wide sum = wide(0.0F);
  for (std::size_t i = step_shape::rise.count; i > 0; --i) sum = fma(v, sum, of(step_shape::rise, i - 1));
  return -(v * v * v * sum);
}

/// Returns a sum of Legendre polynomials of x.
template <class Shape>
HWY_INLINE Wide legendre_sum(const Shape& of, const ShapePart& part, const Wide& x) {
  Wide before = wide(1.0F), now = x, sum = fma(of(part, 1), x, of(part, 0));
  for (std::size_t k = 2; k < part.count; ++k) {
    const auto degree = static_cast<float>(k);
    const Wide next = (x * now) * ((2 * degree - 1) / degree) - before * ((degree - 1) / degree);
    before = now;
    now = next;
    sum = fma(of(part, k), now, sum);
  }
  return sum;
}

/// Returns 64 (u (1 − u))³: 1 in the middle, 0 at both ends with two derivatives.
HWY_INLINE Wide bump(const Wide& u) {
  const Wide q = u * (1.0F - u);
  return 64.0F * q * q * q;
}

/// Returns the bump times Legendre polynomials.
template <class Shape>
HWY_INLINE Wide bumps(const Shape& of, const ShapePart& part, const Wide& u) {
  return bump(u) * legendre_sum(of, part, 2.0F * u - 1.0F);
}

/// A value and its first two derivatives.
struct Moving {
  Wide value, rate, bend;
};

/// Returns the toes' pitch, heel up, of a foot whose heel has risen by `heel_up`, with its derivatives by that.
HWY_INLINE Moving toe_pitch(const Wide& heel_up) {
  constexpr float w2 = toe_rocker::within * toe_rocker::within, part = toe_rocker::part;
  const Wide d = max(heel_up - toe_rocker::from, 0.0F), d2 = d * d, r = 1.0F / (d2 + w2);
  return {part * d * d2 * r, part * d2 * (d2 + 3.0F * w2) * r * r,
          (2.0F * part * w2) * d * (3.0F * w2 - d2) * r * r * r};
}

/// The ankle of a planted foot by its pitch, with derivatives: distance ahead of the foothold along the foot, and
/// height. Toes up, the foot rolls on the rim of its heel; heel up, over its toes.
struct PlantedAnkle {
  Moving along, up;
  Wide toes;  // upward bend of the toes
};

/// Inlined, so that callers that use only the places do not pay for the derivatives.
HWY_INLINE PlantedAnkle planted_ankle(const Wide& height, const Wide& pitch) {
  using namespace unit_foot;
  Wide s, c, q_s, q_c;
  sin_cos(pitch, s, c);
  const Wide heel_up = max(-pitch, 0.0F);
  const Moving q = toe_pitch(heel_up);
  sin_cos(q.value, q_s, q_c);
  const WideMask on_heel = pitch >= 0.0F;
  // heel up: the joint from the tips, the ankle from the joint; s is minus the sine of the heel's rise
  const Wide joint_y = fma(wide(toes), q_s, joint * q_c), joint_z = fma(wide(toes), q_c, -joint * q_s);
  const Wide ankle_y = fma(wide(-ball), s, over_joint * c), ankle_z = fma(wide(ball), c, over_joint * s);
  const Wide bend2 = q.rate * q.rate;
  const Wide rolled = fma(wide(back), c, -over_rim * s), risen = fma(wide(back), s, over_rim * c);
  PlantedAnkle a;
  a.along = {select(on_heel, rolled - back - rim * pitch, (ball + toes) - joint_z - ankle_z),
             select(on_heel, -risen - rim, -fma(joint_y, q.rate, ankle_y)),
             select(on_heel, -rolled, fma(joint_y, q.bend, fma(joint_z, bend2, ankle_z)))};
  a.up = {select(on_heel, risen + rim, joint_y + ankle_y), select(on_heel, rolled, -fma(joint_z, q.rate, ankle_z)),
          select(on_heel, -risen, fma(joint_z, q.bend, -fma(joint_y, bend2, ankle_y)))};
  for (Moving* m : {&a.along, &a.up}) *m = {m->value * height, m->rate * height, m->bend * height};
  a.toes = heel_up - q.value;
  return a;
}

HWY_INLINE Wide quintic_at(const Quintic<Lanes<float>>& q, const Wide& u) {
  Wide sum = load(q.coefficient[5]);
  for (std::size_t k = 5; k > 0; --k) sum = fma(sum, u, load(q.coefficient[k - 1]));
  return sum;
}

/// Stores the quintic from one state at u = 0 to another at u = 1, derivatives by u.
HWY_NOINLINE inline void store_quintic(const Moving& a, const Moving& b, Quintic<Lanes<float>>& out) {
  const Wide r = b.value - a.value - a.rate - 0.5F * a.bend, s = b.rate - a.rate - a.bend, q = 0.5F * (b.bend - a.bend);
  store(a.value, out.coefficient[0]);
  store(a.rate, out.coefficient[1]);
  store(0.5F * a.bend, out.coefficient[2]);
  store(10.0F * r - 4.0F * s + q, out.coefficient[3]);
  store(7.0F * s - 15.0F * r - 2.0F * q, out.coefficient[4]);
  store(6.0F * r - 3.0F * s + q, out.coefficient[5]);
}

/// Returns the step's phase at a part of its time, with the pace of the strikes and no change of pace at either end.
HWY_INLINE Wide step_phase(const Wide& from, const Wide& to, const Wide& u) {
  const Wide r = 1.0F - from, s = to - from;
  return u * fma(u * u, fma(u, fma(u, 6.0F * r - 3.0F * s, 7.0F * s - 15.0F * r), 10.0F * r - 4.0F * s), from);
}
HWY_NOINLINE inline Wide step_phase(const StepPlan<Lanes<float>>& plan, const Wide& u) {
  return step_phase(load(plan.phase_rate_from), load(plan.phase_rate_to), u);
}

/// Returns the part of a step's time at a phase.
HWY_NOINLINE inline Wide time_of_phase(const StepPlan<Lanes<float>>& plan, const Wide& phase) {
  Wide low = wide(0.0F), high = wide(1.0F);
  for (int i = 0; i < 20; ++i) {
    const Wide middle = 0.5F * (low + high);
    const WideMask later = step_phase(plan, middle) < phase;
    low = select(later, middle, low);
    high = select(later, high, middle);
  }
  return high;
}

/// Returns the part of the mix of the shapes' numbers.
HWY_INLINE Wide mixed_part(const StepPlan<Lanes<float>>& plan, const Wide& phase) {
  const Wide start = load(plan.mixed_from);
  return smooth((phase - start) / (1.0F - start));
}

/// Heel rise of a first step, relative to the coming walk.
constexpr float first_rise = 0.3F;

/// Numbers of the heel rise with which the other foot leaves the ground: of the walk before it, or of a first step.
struct LeavingShape {
  const StepPlan<Lanes<float>>& plan;
  WideMask first;
  HWY_INLINE explicit LeavingShape(const StepPlan<Lanes<float>>& of) : plan(of), first(stands(of.from)) {}
  HWY_INLINE Wide operator()(const ShapePart& p, std::size_t i) const {
    return select(first, first_rise * load(plan.to.shape[p.first + i]), load(plan.from.shape[p.first + i]));
  }
  /// Returns the phase of the step at which the heel starts to rise; it can be before the step.
  HWY_INLINE Wide begins() const {
    const Wide lift = usual_rise + load(plan.from.shape[step_shape::times.first + 1]);
    return select(first, wide(0.0F), 2.0F * lift - 1.0F);
  }
};

/// Returns the pitch of the stance foot.
HWY_NOINLINE inline Wide stance_pitch(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& phase) {
  const OneShape from{plan.from.shape};
  const Wide cycle = 0.5F * phase;
  const Wide rising = 0.5F + mix(load(plan.from.double_support), load(plan.to.double_support), of.part);
  const Wide lift = usual_rise + of(step_shape::times, 1);
  return falling(from, step_shape::strike, cycle / (usual_flat + from(step_shape::times, 0))) +
         heel_rise(of, (cycle - lift) / (rising - lift));
}

/// Returns 64 u³(1 − u)³ times Legendre polynomials of 2u − 1.
HWY_INLINE Wide other_way(const Lanes<float> (&by)[other_way_count], const Wide& u) {
  return bumps(OneShape{by}, {"", 0, other_way_count, 0}, u);
}

/// The middle of the hips: forward from the stance foothold along the line; from there ahead, and to the left while the
/// right foot stands (else to the right).
struct HipsPlace {
  Wide forward, ahead, aside;
};

/// `u` is the part of the step's time at which its phase has those waves.
HWY_NOINLINE inline HipsPlace hips_place(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& u,
                                         const Wide& phase, const StepWaves& w) {
  return {harmonics_about(quintic_at(plan.even_m, phase), of, step_shape::hips_forward, 4, w),
          other_way(plan.ahead_m, u), hips_aside(of, w) - other_way(plan.aside_m, u)};
}

/// Returns the cosine by its series, for |x| < 3.
constexpr float cosine(double x) {
  double term = 1, sum = 1;
  for (int k = 1; k < 16; ++k) {
    term *= -x * x / ((2 * k - 1) * (2 * k));
    sum += term;
  }
  return static_cast<float>(sum);
}

HWY_INLINE Wide posture(const Lanes<float>& from, const Lanes<float>& to, const Wide& part) {
  return mix(load(from), load(to), part);
}

/// Returns cos K π (p − at/1000) from the waves of p.
template <int K, int At>
HWY_INLINE Wide wave(const StepWaves& w) {
  constexpr double half_turn = 3.14159265358979324, angle = half_turn * K * At / 1000;
  constexpr float c = cosine(angle), s = cosine(angle - half_turn / 2);
  return fma(wide(c), w.cosine[K], s * w.sine[K]);
}

/// Return the pelvis' rotation and list, seen from the stance leg: that side forward, and that side up.
HWY_INLINE Wide pelvis_rotation(const StepPlan<Lanes<float>>& plan, const StepWaves& w, const Wide& eased) {
  return posture(plan.from.posture.pelvis_rotation, plan.to.posture.pelvis_rotation, eased) *
         wave<1, pelvis_phase::rotation_1000>(w);
}
HWY_INLINE Wide pelvis_list(const StepPlan<Lanes<float>>& plan, const StepWaves& w, const Wide& eased) {
  namespace p = pelvis_phase;
  return posture(plan.from.posture.pelvis_list, plan.to.posture.pelvis_list, eased) *
         (p::list_first * wave<1, p::list_first_1000>(w) + p::list_third * wave<3, p::list_third_1000>(w));
}

/// Returns the pelvis' tilt, its front down.
HWY_INLINE Wide pelvis_tilt(const StepPlan<Lanes<float>>& plan, const StepWaves& w, const Wide& eased) {
  const PostureParameters<Lanes<float>>&from = plan.from.posture, &to = plan.to.posture;
  return fma(posture(from.pelvis_tilt_wave, to.pelvis_tilt_wave, eased), wave<2, pelvis_phase::tilt_1000>(w),
             posture(from.pelvis_tilt, to.pelvis_tilt, eased));
}

/// Sinking of the pelvis in a step between unlike walks, so that no leg is straight: of the height, per m/s of their
/// difference, and its maximum.
constexpr float sinks_by = 0.015F, max_sinking = 0.006F;

HWY_INLINE Wide hips_height(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height, const Wide& u,
                            const StepWaves& w) {
  constexpr auto standing = static_cast<float>(fraction::hip_height);
  const Wide unlike = abs(load(plan.to.speed_m_s) - load(plan.from.speed_m_s));
  const Wide sunk = fnma(min(sinks_by * unlike, max_sinking), bump(u), wide(standing));
  return fma(sunk, height, harmonics(of, step_shape::hips_up, 4, w));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
