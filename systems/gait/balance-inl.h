// Centre of pressure of a step between unlike strikes, and corrections of the hips' path that keep it under the feet.
// See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#undef MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_BALANCE_INL_H_
#endif

#include "assets/gait/sole-inl.h"
#include "systems/gait/elimination-inl.h"
#include "systems/gait/planar_figure-inl.h"
#include "systems/gait/strike-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Number of equal time intervals at whose ends a step is evaluated.
constexpr std::size_t step_parts = 20;

/// Returns the displacement of the centre of pressure per acceleration of the hips: height of the centre of mass over
/// gravity, s².
HWY_INLINE Wide pendulum(const LegSize& size) {
  // Centres of thigh, shank and foot below the hips, of the unit body's height.
  constexpr float thigh = 0.106F, shank = 0.352F, foot = 0.505F, hips = static_cast<float>(fraction::hip_height);
  const Wide below = 2.0F * fma(size.thigh_mass, wide(thigh), fma(size.shank_mass, wide(shank), size.foot_mass * foot));
  const Wide above = planar_mass(size, planar_points - 1) * above_hips(size, &UpperBodyMotion::above);
  return fma(above, size.upper, (hips - below) * size.leg) * (1.0F / gravity_f);
}

/// Returns the lateral centre of pressure of a steady walk of that shape, from a pendulum on the hips' path.
HWY_NOINLINE inline Wide steady_aside(const HeelStrike<Lanes<float>>& strike, const LegSize& size, const StepWaves& w) {
  const OneShape of{strike.shape};
  const Wide pace = load(strike.pace_hz), per = pendulum(size) * (pi_f * pi_f) * pace * pace;
  const ShapePart& a = step_shape::aside;
  const Wide once = fma(of(a, 0), w.cosine[1], of(a, 2) * w.sine[1]);
  const Wide thrice = fma(of(a, 1), w.cosine[3], of(a, 3) * w.sine[3]);
  return fma(once, 1.0F + per, thrice * fma(per, wide(9.0F), wide(1.0F)));
}

/// Centre of pressure of a step at the instants between its ends, the usual one of walks, and the range of the soles.
struct Pressed {
  Wide at[step_parts], middle[step_parts], least[step_parts], most[step_parts];
};

/// Room on either side of the usual centre of pressure, of the height.
constexpr float room_aside = 0.015F;

/// Minimum vertical force, of the weight: a step that nearly leaves the ground has its centre of pressure anywhere.
/// Maximum of each correction of the hips' path, of the height.
constexpr float min_lift = 0.4F, max_other_way = 0.05F;

HWY_NOINLINE inline void room_ahead(const StepPlan<Lanes<float>>& plan, const MixedShape& of, const Wide& height,
                                    const Wide& phase, const Wide& pitch, const WideMask& both, std::size_t i,
                                    Pressed& ahead) {
  const SoleReach reach = sole_reach(height, pitch), flat = sole_reach(height, wide(0.0F));
  const Wide off = 0.5F + mix(load(plan.from.double_support), load(plan.to.double_support), of.part);
  const Wide back = select(both, min(reach.back, flat.front - load(plan.length_before_m)), reach.back);
  ahead.middle[i] = min(max(pressed(of, height, 0.5F * phase / off), back), reach.front);
  ahead.least[i] = back;
  ahead.most[i] = reach.front;
}

/// Computes the centre of pressure of a step before it is balanced.
HWY_NOINLINE inline void look_at_step(const StepPlan<Lanes<float>>& plan, const LegSize& size, Pressed& ahead,
                                      Pressed& aside) {
  const Wide& height = size.leg;
  const Wide per_apart = static_cast<float>(step_parts) / load(plan.duration_s);
  const Wide per_aside = pendulum(size) * per_apart * per_apart;
  const Wide width = load(plan.from.half_width_m) + load(plan.to.half_width_m);
  const WideMask from_stands = stands(plan.from), to_stands = stands(plan.to);
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  Wide s, along;
  sin_cos(load(plan.slant_rad), s, along);
  PlanarFigure figure[3];
  PlanarMotion before{wide(0.0F), wide(0.0F)};
  StepWaves waves[2];
  Wide phase[2];
  for (std::size_t k = 0; k <= step_parts; ++k) {
    const Wide u = wide(static_cast<float>(k) / step_parts);
    phase[k % 2] = step_phase(plan, u);
    waves[k % 2] = step_waves(phase[k % 2]);
    planar_figure(plan, size, u, phase[k % 2], waves[k % 2], along, figure[k % 3]);
    if (k == 0) continue;
    const PlanarFigure& last = figure[(k + 2) % 3];
    const PlanarMotion now = planar_motion(last, figure[k % 3], size, per_apart);
    if (k > 1) {
      const std::size_t i = k - 1;
      Wide centre = wide(0.0F);
      for (std::size_t j = 0; j < planar_points; ++j) centre = fma(planar_mass(size, j), last.forward[j], centre);
      const Wide lift = max(fma(now.rising - before.rising, per_apart, wide(gravity_f)), min_lift * gravity_f);
      ahead.at[i] = fma(wide(gravity_f), centre, (now.turning - before.turning) * per_apart) / lift;
      const Wide& p = phase[i % 2];
      const WideMask both = (p < off) | (p > landing);
      const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, p)};
      room_ahead(plan, of, height, p, last.stance_pitch, both, i, ahead);

      aside.at[i] = last.aside - per_aside * (figure[k % 3].aside - 2.0F * last.aside + figure[(k + 1) % 3].aside);
      // A standing person presses between the feet while both are on the ground.
      const Wide part = select(from_stands, smooth(p / max(off, 1e-3F)),
                               select(to_stands, smooth((p - landing) / max(1.0F - landing, 1e-3F)), of.part));
      aside.middle[i] =
          mix(steady_aside(plan.from, size, waves[i % 2]), steady_aside(plan.to, size, waves[i % 2]), part);
      aside.least[i] = aside.middle[i] - room_aside * height;
      aside.most[i] = aside.middle[i] + select(both, width, room_aside * height);
    }
    before = now;
  }
}

constexpr std::size_t other_ways = other_way_count;

/// Value and second derivative of each correction of the hips' path, as functions of the part of the step's time.
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

/// Part of the room that the centre of pressure can use.
constexpr float room_used = 0.7F;

/// Solves for the corrections that bring the centre of pressure into its room. Returns how far it stays outside.
HWY_NOINLINE inline Wide into_room(const Elimination<other_ways>& normal, const Wide (&effect)[step_parts][other_ways],
                                   const Pressed& pressed, Wide (&by)[other_ways]) {
  constexpr int rounds = 4;
  Wide worst = wide(0.0F);
  for (std::size_t k = 0; k < other_ways; ++k) by[k] = wide(0.0F);
  for (int round = 0; round < rounds; ++round) {
    Wide sum[other_ways];
    for (std::size_t k = 0; k < other_ways; ++k) sum[k] = wide(0.0F);
    for (std::size_t i = 1; i < step_parts; ++i) {
      Wide reached = pressed.at[i];
      for (std::size_t k = 0; k < other_ways; ++k) reached = fma(effect[i][k], by[k], reached);
      const Wide used = wide(room_used), least = mix(pressed.middle[i], pressed.least[i], used);
      const Wide wanted = min(max(reached, least), mix(pressed.middle[i], pressed.most[i], used)) - pressed.at[i];
      for (std::size_t k = 0; k < other_ways; ++k) sum[k] = fma(effect[i][k], wanted, sum[k]);
    }
    for (std::size_t k = 0; k < other_ways; ++k) by[k] = sum[k];
    normal.solve(by);
  }
  for (std::size_t i = 1; i < step_parts; ++i) {
    Wide reached = pressed.at[i];
    for (std::size_t k = 0; k < other_ways; ++k) reached = fma(effect[i][k], by[k], reached);
    worst = max(worst, max(pressed.least[i] - reached, reached - pressed.most[i]));
  }
  return worst;
}

/// Computes, for standing people who move a foot, the reach of both soles and the lateral centre of pressure of the
/// step as a pendulum. `right_one` is 1 if the right foot stands, otherwise −1.
HWY_NOINLINE inline void look_at_feet(const StepPlan<Lanes<float>>& plan, const LegSize& size, const Wide& right_one,
                                      Pressed& ahead, Pressed& aside) {
  const Wide per_apart = static_cast<float>(step_parts) / load(plan.duration_s);
  const Wide per = pendulum(size) * per_apart * per_apart;
  const Wide before = load(plan.length_before_m), length = load(plan.step_length_m);
  const Wide off = load(plan.double_support), landing = load(plan.landing);
  const SoleReach reach = sole_reach(size.leg, wide(0.0F));
  const Wide half = sole::half_width * size.leg;
  Wide s, c;
  sin_cos(load(plan.slant_rad), s, c);
  s = s * right_one;
  // Positions of the bearing feet relative to the stance foot: forward, and to the side in the sign of hips_place.
  const Wide stance_aside = -load(plan.from.half_width_m);
  const Wide last_forward = -before * c, last_aside = fnma(before, s, load(plan.trailing_half_width_m));
  const Wide next_forward = length * c, next_aside = fma(length, s, load(plan.to.half_width_m));
  Wide way[3];
  for (std::size_t k = 0; k <= step_parts; ++k) {
    const Wide u = wide(static_cast<float>(k) / step_parts);
    way[k % 3] = quintic_at(plan.even_m, step_phase(plan, u));
    if (k < 2) continue;
    const std::size_t i = k - 1;
    const Wide at = step_phase(plan, wide(static_cast<float>(i) / step_parts));
    const WideMask early = at < off;
    const WideMask late = at > landing;
    const Wide pressed = way[i % 3] - per * (way[k % 3] - 2.0F * way[i % 3] + way[(i + 2) % 3]);
    auto within = [&](const Wide& stance, const Wide& last, const Wide& next, const Wide& back, const Wide& front,
                      Pressed& out) {
      const Wide other = select(early, last, select(late, next, stance));
      out.least[i] = min(stance, other) + back;
      out.most[i] = max(stance, other) + front;
      out.middle[i] = 0.5F * (out.least[i] + out.most[i]);
    };
    within(wide(0.0F), last_forward, next_forward, reach.back, reach.front, ahead);
    within(stance_aside, last_aside, next_aside, -half, half, aside);
    aside.at[i] = pressed * s;
  }
}

/// Chooses plan.ahead_m and aside_m. Returns the distance of the resulting centre of pressure outside the soles.
HWY_NOINLINE inline Wide balance_step(const LegSize& size, const Wide& right_one, const WideMask& alike,
                                      const WideMask& on_spot, StepPlan<Lanes<float>>& plan) {
  for (std::size_t k = 0; k < other_ways; ++k) {
    store(wide(0.0F), plan.ahead_m[k]);
    store(wide(0.0F), plan.aside_m[k]);
  }
  if (!any(select(alike, wide(0.0F), wide(1.0F)) > 0.0F)) return wide(0.0F);
  Pressed ahead, aside;
  look_at_step(plan, size, ahead, aside);
  if (any(on_spot)) {
    Pressed standing_ahead = ahead, standing_aside;
    look_at_feet(plan, size, right_one, standing_ahead, standing_aside);
    for (std::size_t i = 1; i < step_parts; ++i) {
      for (auto number : {&Pressed::at, &Pressed::middle, &Pressed::least, &Pressed::most}) {
        (ahead.*number)[i] = select(on_spot, (standing_ahead.*number)[i], (ahead.*number)[i]);
        (aside.*number)[i] = select(on_spot, (standing_aside.*number)[i], (aside.*number)[i]);
      }
    }
  }
  const Wide per = pendulum(size) / (load(plan.duration_s) * load(plan.duration_s));
  Elimination<other_ways> normal;
  for (std::size_t k = 0; k < other_ways; ++k) {
    for (std::size_t j = 0; j < other_ways; ++j) normal.a[k][j] = wide(j == k ? 1e-3F : 0.0F);
  }
  Wide effect[step_parts][other_ways];
  for (std::size_t i = 1; i < step_parts; ++i) {
    const OtherWay o = other_way_at(static_cast<float>(i) / step_parts);
    for (std::size_t k = 0; k < other_ways; ++k) effect[i][k] = fnma(per, wide(o.bend[k]), wide(o.place[k]));
    for (std::size_t k = 0; k < other_ways; ++k)
      for (std::size_t j = 0; j < other_ways; ++j) normal.a[k][j] = fma(effect[i][k], effect[i][j], normal.a[k][j]);
  }
  normal.factor();
  auto choose = [&](const Pressed& pressed, Lanes<float>(&way)[other_way_count], float sign) {
    Wide by[other_ways];
    const Wide outside = into_room(normal, effect, pressed, by), most = max_other_way * size.leg;
    for (std::size_t k = 0; k < other_ways; ++k)
      store(select(alike, wide(0.0F), sign * min(max(by[k], -most), most)), way[k]);
    return select(alike, wide(0.0F), outside);
  };
  return max(choose(ahead, plan.ahead_m, 1.0F), choose(aside, plan.aside_m, -1.0F));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
