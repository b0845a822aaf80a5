// Where a step between unlike strikes would press the ground, and another way of the hips that presses it where feet
// are. Include it as engine/wide-inl.h says.

#if defined(MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#endif

#include "assets/gait/step_curves-inl.h"
#include "systems/gait/elimination-inl.h"
#include "systems/gait/strike-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {

/// Instants of a step at which it is looked at.
constexpr std::size_t balance_instants = 17;

/// How far the centre of pressure goes per acceleration of the hips: height of the centre of mass over gravity, s².
HWY_INLINE Wide pendulum(const Wide& height) {
  constexpr float centre = 0.56F;  // of mass, of the height
  return height * (centre / gravity_f);
}

/// Two numbers of each instant: forward and aside.
struct OnGround {
  Wide forward, aside;
};

/// Where a steady walk of that shape presses the ground at a phase, as a pendulum on the hips' way: from the stance
/// foothold.
HWY_NOINLINE inline OnGround steady_pressure(const Strike<Lanes<float>>& strike, const Wide& height, const StepWaves& w,
                                             const Wide& phase) {
  const OneShape of{strike.shape};
  const Wide pace = load(strike.pace_hz), per = pendulum(height) * (pi_f * pi_f) * pace * pace;
  const Wide length = load(strike.speed_m_s) / max(pace, 0.1F);
  OnGround sum = {fma(length, phase, of(step_shape::hips_forward, 0)), wide(0.0F)};
  for (std::size_t k = 1; k <= 4; ++k) {
    const auto turns = static_cast<float>(4 * k * k);
    const Wide wave =
        fma(of(step_shape::hips_forward, k), w.cosine[2 * k], of(step_shape::hips_forward, 4 + k) * w.sine[2 * k]);
    sum.forward = fma(wave, fma(per, wide(turns), wide(1.0F)), sum.forward);
  }
  const ShapePart& a = step_shape::aside;
  const Wide once = fma(of(a, 0), w.cosine[1], of(a, 2) * w.sine[1]);
  const Wide thrice = fma(of(a, 1), w.cosine[3], of(a, 3) * w.sine[3]);
  sum.aside = fma(once, 1.0F + per, thrice * fma(per, wide(9.0F), wide(1.0F)));
  return sum;
}

/// By how much the step lacks to press where its strikes' walks do, in between mixed as the feet take over; at equal
/// times.
HWY_NOINLINE inline void lacking(const StepPlan<Lanes<float>>& plan, const Wide& height,
                                 OnGround (&out)[balance_instants]) {
  constexpr std::size_t n = balance_instants - 1;
  constexpr float h = 1.0F / 256;
  const Wide per = pendulum(height) / (load(plan.duration_s) * load(plan.duration_s)) * (1.0F / (h * h));
  const WideMask from_stands = load(plan.from.speed_m_s) <= 0.0F, to_stands = load(plan.to.speed_m_s) <= 0.0F;
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  for (std::size_t i = 0; i <= n; ++i) {
    const float at = static_cast<float>(i) / n;
    HipsPlace place[3];
    Wide phase;
    StepWaves waves;
    for (std::size_t k = 0; k < 3; ++k) {
      const float u = at < h       ? static_cast<float>(k) * h
                      : at > 1 - h ? 1 + (static_cast<float>(k) - 2) * h
                                   : at + (static_cast<float>(k) - 1) * h;
      phase = step_phase(plan, wide(u));
      waves = step_waves(phase);
      place[k] = hips_place(plan, {plan.from.shape, plan.to.shape, mixed_part(plan, phase)}, wide(u), phase, waves);
    }
    phase = step_phase(plan, wide(at));
    waves = step_waves(phase);
    const OnGround a = steady_pressure(plan.from, height, waves, phase),
                   b = steady_pressure(plan.to, height, waves, phase);
    // Somebody who stands presses between the feet, for as long as both are on the ground.
    const Wide part =
        select(from_stands, smooth(phase / max(off, 1e-3F)),
               select(to_stands, smooth((phase - landing) / max(1.0F - landing, 1e-3F)), mixed_part(plan, phase)));
    auto motion = [&](Wide HipsPlace::*of) {
      return place[1].*of - per * (place[0].*of - 2.0F * (place[1].*of) + place[2].*of);
    };
    out[i] = {mix(a.forward, b.forward, part) - motion(&HipsPlace::forward),
              mix(a.aside, b.aside, part) - motion(&HipsPlace::aside)};
  }
}

constexpr std::size_t other_ways = other_way_count;

/// What each of the hips' other ways does at a part of the step's time: place, and acceleration by that part.
struct OtherWay {
  float place[other_ways], bend[other_ways];
};

constexpr OtherWay other_way_at(float u) {
  const float x = 2 * u - 1, q = u * (1 - u);  // q' = −x, x' = 2
  const float b = 64 * q * q * q, b1 = -192 * q * q * x, b2 = 384 * q * x * x - 384 * q * q;
  const float p[5] = {1, x, 1.5F * x * x - 0.5F, (2.5F * x * x - 1.5F) * x,
                      ((4.375F * x * x - 3.75F) * x * x) + 0.375F};
  const float d[5] = {0, 1, 3 * x, 7.5F * x * x - 1.5F, (17.5F * x * x - 7.5F) * x};
  const float c[5] = {0, 0, 3, 15 * x, 52.5F * x * x - 7.5F};
  OtherWay o{};
  for (std::size_t k = 0; k < other_ways; ++k) {
    o.place[k] = b * p[k];
    o.bend[k] = b2 * p[k] + 4 * b1 * d[k] + 4 * b * c[k];
  }
  return o;
}

/// Chooses plan.ahead_m and aside_m; returns how far the centre of pressure still lies from where the walks have it.
HWY_NOINLINE inline Wide balance_step(const Wide& height, const WideMask& alike, StepPlan<Lanes<float>>& plan) {
  constexpr std::size_t n = balance_instants - 1;
  for (std::size_t k = 0; k < other_ways; ++k) {
    store(wide(0.0F), plan.ahead_m[k]);
    store(wide(0.0F), plan.aside_m[k]);
  }
  OnGround lack[balance_instants];
  lacking(plan, height, lack);
  const Wide per = pendulum(height) / (load(plan.duration_s) * load(plan.duration_s));
  Elimination<other_ways> normal;
  Wide forward[other_ways], aside[other_ways];
  for (std::size_t k = 0; k < other_ways; ++k) {
    forward[k] = aside[k] = wide(0.0F);
    for (std::size_t j = 0; j < other_ways; ++j) normal.a[k][j] = wide(j == k ? 1e-3F : 0.0F);
  }
  auto effect_at = [&](std::size_t i, Wide(&effect)[other_ways]) {
    const OtherWay o = other_way_at(static_cast<float>(i) / n);
    for (std::size_t k = 0; k < other_ways; ++k) effect[k] = fnma(per, wide(o.bend[k]), wide(o.place[k]));
  };
  for (std::size_t i = 1; i < n; ++i) {
    Wide effect[other_ways];
    effect_at(i, effect);
    for (std::size_t k = 0; k < other_ways; ++k) {
      for (std::size_t j = 0; j < other_ways; ++j) normal.a[k][j] = fma(effect[k], effect[j], normal.a[k][j]);
      forward[k] = fma(effect[k], lack[i].forward, forward[k]);
      aside[k] = fma(effect[k], lack[i].aside, aside[k]);
    }
  }
  normal.factor();
  normal.solve(forward);
  normal.solve(aside);
  for (std::size_t k = 0; k < other_ways; ++k) {
    forward[k] = select(alike, wide(0.0F), forward[k]);
    aside[k] = select(alike, wide(0.0F), aside[k]);
    store(forward[k], plan.ahead_m[k]);
    store(-aside[k], plan.aside_m[k]);
  }
  Wide worst = wide(0.0F);
  for (std::size_t i = 1; i < n; ++i) {
    Wide effect[other_ways], ahead = lack[i].forward, to_side = lack[i].aside;
    effect_at(i, effect);
    for (std::size_t k = 0; k < other_ways; ++k) {
      ahead = fnma(effect[k], forward[k], ahead);
      to_side = fnma(effect[k], aside[k], to_side);
    }
    worst = max(worst, max(abs(ahead), abs(to_side)));
  }
  return worst;
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
