// The swing leg of the paper (section 4.1): thigh and shank hang on the moving hip. A few parameters of their torques
// are solved so that the foot lands as the step requires. See engine/wide-inl.h for how to include it.

#if defined(MOBIL_SYSTEMS_GAIT_FORWARD_SWING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_GAIT_FORWARD_SWING_INL_H_
#undef MOBIL_SYSTEMS_GAIT_FORWARD_SWING_INL_H_
#else
#define MOBIL_SYSTEMS_GAIT_FORWARD_SWING_INL_H_
#endif

#include "systems/gait/elimination-inl.h"
#include "systems/gait/swing_leg-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Fourth-order Runge–Kutta steps from toe-off to heel strike, equal in time. Swings are also evaluated at their
/// middles.
constexpr std::size_t swing_steps = 8, swing_instants = 2 * swing_steps + 1;

/// Parameters of the torques, in this order: the hip's pulses in early and in late swing; the knee's stiffness, its
/// stiffness times its rest angle, its damping and its late pulse.
constexpr std::size_t torque_count = 6, hip_torques = 2;

/// Middle and width of a pulse, as parts of the swing.
struct Pulse {
  double middle, width;
};
constexpr Pulse pulses[] = {{0.1, 0.25}, {0.9, 0.2}, {0.9, 0.12}};

constexpr double exponential(double x) {
  double term = 1, sum = 1;
  for (int k = 1; k < 20; ++k) sum += term *= x / (16 * k);
  for (int k = 0; k < 4; ++k) sum *= sum;
  return sum;
}

/// Pulses at each instant, and weights of the corrections that bring the torques at toe-off and at heel strike to those
/// of the step, so that accelerations are continuous.
struct TorqueTimes {
  float pulse[3][swing_instants], off[swing_instants], on[swing_instants];
};
constexpr TorqueTimes torque_times = [] {
  TorqueTimes t{};
  constexpr double over_off = 0.15, over_on = 0.1;  // of the swing
  auto cube = [](double x) { return x > 0 ? static_cast<float>(x * x * x) : 0.0F; };
  for (std::size_t i = 0; i < swing_instants; ++i) {
    const double s = static_cast<double>(i) / (swing_instants - 1);
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = (s - pulses[k].middle) / pulses[k].width;
      t.pulse[k][i] = static_cast<float>(1 / exponential(x * x));
    }
    t.off[i] = cube(1 - s / over_off);
    t.on[i] = cube((s - 1 + over_on) / over_on);
  }
  return t;
}();

/// Factors of the torque parameters for a leg in a given state, hip before knee.
struct TorqueParts {
  Wide of[torque_count];
};

HWY_INLINE TorqueParts torque_parts(std::size_t instant, const SwingState& y) {
  return {{wide(torque_times.pulse[0][instant]), wide(torque_times.pulse[1][instant]), y.thigh - y.shank, wide(-1.0F),
           y.thigh_rate - y.shank_rate, wide(torque_times.pulse[2][instant])}};
}

/// The swing of a step: states of its leg and accelerations of the hip; torques and their factors at both ends; the
/// part of the swing at each instant, and the time between instants.
struct SwingToMeet {
  SwingState at[swing_instants];
  Pull pull[swing_instants];
  Wide part[swing_instants];
  Torques off, on;
  TorqueParts parts_off, parts_on;
  Wide apart_s;
};

/// Returns the torque factors minus their values at the ends.
HWY_INLINE TorqueParts closed_parts(const SwingToMeet& swing, std::size_t instant, const SwingState& y) {
  TorqueParts parts = torque_parts(instant, y);
  const float off = torque_times.off[instant], on = torque_times.on[instant];
  for (std::size_t k = 0; k < torque_count; ++k)
    parts.of[k] = parts.of[k] - off * swing.parts_off.of[k] - on * swing.parts_on.of[k];
  return parts;
}

/// Returns the torques due to the ends alone.
HWY_INLINE Torques end_torques(const SwingToMeet& swing, std::size_t instant) {
  const float off = torque_times.off[instant], on = torque_times.on[instant];
  return {off * swing.off.hip + on * swing.on.hip, off * swing.off.knee + on * swing.on.knee};
}

/// A state and its derivatives with respect to the torque parameters.
struct SwingFlow {
  SwingState state, by[torque_count];
};

/// Computes the rates of change of a state and of its derivatives.
HWY_NOINLINE inline void swing_rates(const SwingLeg& leg, const SwingToMeet& swing, const Wide (&number)[torque_count],
                                     std::size_t instant, const SwingFlow& y, SwingFlow& rate) {
  const TorqueParts parts = closed_parts(swing, instant, y.state);
  Torques torque = end_torques(swing, instant);
  for (std::size_t k = 0; k < torque_count; ++k) {
    Wide& sum = k < hip_torques ? torque.hip : torque.knee;
    sum = fma(number[k], parts.of[k], sum);
  }
  const SwingBends bends(leg, y.state, swing.pull[instant], torque);
  rate.state = {y.state.thigh_rate, y.state.shank_rate, bends.thigh, bends.shank};
  for (std::size_t k = 0; k < torque_count; ++k) {
    const SwingState& d = y.by[k];
    Torques by = {wide(0.0F), fma(number[2], d.thigh - d.shank, number[4] * (d.thigh_rate - d.shank_rate))};
    (k < hip_torques ? by.hip : by.knee) = (k < hip_torques ? by.hip : by.knee) + parts.of[k];
    rate.by[k] = bends.derivative(d, by);
  }
}

HWY_INLINE SwingState moved(const SwingState& y, const SwingState& rate, const Wide& by) {
  return {fma(by, rate.thigh, y.thigh), fma(by, rate.shank, y.shank), fma(by, rate.thigh_rate, y.thigh_rate),
          fma(by, rate.shank_rate, y.shank_rate)};
}

HWY_NOINLINE inline void move(const SwingFlow& y, const SwingFlow& rate, const Wide& by, SwingFlow& out) {
  out.state = moved(y.state, rate.state, by);
  for (std::size_t k = 0; k < torque_count; ++k) out.by[k] = moved(y.by[k], rate.by[k], by);
}

/// Fits the parameters by least squares to the torques of the step's own swing.
HWY_NOINLINE inline void first_numbers(const SwingLeg& leg, const SwingToMeet& swing, Wide (&number)[torque_count]) {
  LeastSquares<torque_count> fit({0.5F, 0.5F, 0.015F, 0.015F, 1.5F, 0.015F});
  const Wide per = 0.5F / swing.apart_s;
  for (std::size_t i = 1; i + 1 < swing_instants; ++i) {
    const SwingState &before = swing.at[i - 1], &now = swing.at[i], &next = swing.at[i + 1];
    const Torques taken = leg.torques(now, (next.thigh_rate - before.thigh_rate) * per,
                                      (next.shank_rate - before.shank_rate) * per, swing.pull[i]);
    const TorqueParts parts = closed_parts(swing, i, now);
    const Torques ends = end_torques(swing, i);
    Wide hip[torque_count], knee[torque_count];
    for (std::size_t k = 0; k < torque_count; ++k) {
      hip[k] = k < hip_torques ? parts.of[k] : wide(0.0F);
      knee[k] = k < hip_torques ? wide(0.0F) : parts.of[k];
    }
    fit.ask(hip, taken.hip - ends.hip);
    fit.ask(knee, taken.knee - ends.knee);
  }
  fit.solve();
  for (std::size_t k = 0; k < torque_count; ++k) number[k] = fit.sum[k];
}

/// Weights of the aims of a swing: per rad, rad/s, body height, and per scale of a parameter's difference from its
/// first value.
namespace swing_weight {
constexpr float angle = 20.0F, rate = 2.0F, ankle_up = 35.0F, late_knee = 40.0F, first = 0.03F, damping = 0.02F;
constexpr float scale[torque_count] = {0.065F, 0.1F, 0.065F, 0.05F, 0.003F, 0.065F};
}  // namespace swing_weight

/// Advances `y` by one integration step of a swing.
HWY_NOINLINE inline void swing_on(const SwingLeg& leg, const SwingToMeet& swing, const Wide (&number)[torque_count],
                                  std::size_t step, SwingFlow& y) {
  const Wide half = swing.apart_s, whole = 2.0F * half;
  SwingFlow rate, there, end = y;
  swing_rates(leg, swing, number, 2 * step, y, rate);
  move(end, rate, whole * (1.0F / 6), end);
  move(y, rate, half, there);
  swing_rates(leg, swing, number, 2 * step + 1, there, rate);
  move(end, rate, whole * (1.0F / 3), end);
  move(y, rate, half, there);
  swing_rates(leg, swing, number, 2 * step + 1, there, rate);
  move(end, rate, whole * (1.0F / 3), end);
  move(y, rate, whole, there);
  swing_rates(leg, swing, number, 2 * step + 2, there, rate);
  move(end, rate, whole * (1.0F / 6), y);
}

/// Returns the knee angle halfway through a step, from a cubic.
HWY_INLINE Wide halfway_knee(const SwingState& a, const SwingState& b, const Wide& step_s) {
  return 0.5F * (a.thigh - a.shank + b.thigh - b.shank) +
         0.125F * step_s * (a.thigh_rate - a.shank_rate - b.thigh_rate + b.shank_rate);
}

/// Integrates a swing, then improves its parameters by one Levenberg–Marquardt step. The aims are the state at heel
/// strike, the ankle's height at three instants, and the knee angle shortly before landing, so that it does not lock.
/// Returns the leg after each step.
HWY_NOINLINE inline void swing_forward(const SwingLeg& leg, const SwingToMeet& swing, const Wide (&first)[torque_count],
                                       Wide (&number)[torque_count], SwingState (&way)[swing_steps + 1]) {
  namespace weight = swing_weight;
  constexpr float held = weight::first * weight::first;
  LeastSquares<torque_count> fit({held, held, held, held, held, held});
  for (std::size_t k = 0; k < torque_count; ++k) fit.sum[k] = (first[k] - number[k]) * (held / weight::scale[k]);
  SwingFlow before, y;
  auto meet = [&](const Wide& lacks, float counts, auto by) {
    Wide row[torque_count];
    for (std::size_t k = 0; k < torque_count; ++k) row[k] = by(k) * (counts * weight::scale[k]);
    fit.ask(row, counts * lacks);
  };
  y.state = way[0] = swing.at[0];
  for (auto& by : y.by) by = {wide(0.0F), wide(0.0F), wide(0.0F), wide(0.0F)};
  for (std::size_t i = 0; i < swing_steps; ++i) {
    before = y;
    swing_on(leg, swing, number, i, y);
    way[i + 1] = y.state;
    if (i + 1 == swing_steps || i % 2 == 0) continue;
    const AnkleBelow is(leg, y.state);
    meet(AnkleBelow(leg, swing.at[2 * i + 2]).up - is.up, weight::ankle_up,
         [&](std::size_t k) { return is.up_by(y.by[k]); });
  }
  const SwingState &lands = y.state, &late = swing.at[swing_instants - 2], &met = swing.at[swing_instants - 1];
  const Wide step_s = 2.0F * swing.apart_s;
  meet(late.thigh - late.shank - halfway_knee(before.state, lands, step_s), weight::late_knee,
       [&](std::size_t k) { return halfway_knee(before.by[k], y.by[k], step_s); });
  meet(met.thigh - lands.thigh, weight::angle, [&](std::size_t k) { return y.by[k].thigh; });
  meet(met.shank - lands.shank, weight::angle, [&](std::size_t k) { return y.by[k].shank; });
  meet(met.thigh_rate - lands.thigh_rate, weight::rate, [&](std::size_t k) { return y.by[k].thigh_rate; });
  meet(met.shank_rate - lands.shank_rate, weight::rate, [&](std::size_t k) { return y.by[k].shank_rate; });
  for (std::size_t k = 0; k < torque_count; ++k) fit.normal.a[k][k] = fit.normal.a[k][k] * (1.0F + weight::damping);
  fit.solve();
  for (std::size_t k = 0; k < torque_count; ++k) number[k] = fma(wide(weight::scale[k]), fit.sum[k], number[k]);
}

/// Computes the swing of a step from its curves.
HWY_NOINLINE inline void swing_to_meet(const StepPlan<Lanes<float>>& plan, const SwingLeg& leg, const LegSize& size,
                                       SwingToMeet& out) {
  constexpr std::size_t last = swing_instants - 1;
  const Wide& height = size.leg;
  const Wide per_time = 1.0F / load(plan.duration_s), per_height = 1.0F / height, from = load(plan.double_support_s);
  Wide s, along;
  sin_cos(load(plan.slant_rad), s, along);
  out.apart_s = (load(plan.duration_s) - from) * (1.0F / last);
  auto seen = [&](const Wide& time) {
    const Wide u = time * per_time, phase = step_phase(plan, u);
    const MixedShape of{plan.from.shape, plan.to.shape, mixed_part(plan, phase)};
    const HipsSeen hips = hips_seen(plan, of, size, u, phase, step_waves(phase), along);
    OtherLeg l = other_leg(plan, of, height, phase, hips, along);
    for (Wide* length : {&l.hip_forward, &l.hip_up, &l.ankle_forward, &l.ankle_up}) *length = *length * per_height;
    return l;
  };
  const Wide gravity = forces::gravity * per_height;
  auto pulled = [&](const OtherLeg& a, const OtherLeg& b, const OtherLeg& c, const Wide& per2) {
    return Pull{(a.hip_forward - 2.0F * b.hip_forward + c.hip_forward) * per2,
                (a.hip_up - 2.0F * b.hip_up + c.hip_up) * per2 + gravity};
  };
  // Distance from the ends at which rates and accelerations are taken there, of the time between instants.
  constexpr float near = 0.125F;
  auto end = [&](const Wide& time, const OtherLeg& at, SwingState& state, Pull& pull, Torques& torque) {
    const Wide h = near * out.apart_s, per = 1.0F / h, per2 = per * per;
    const OtherLeg before = seen(time - h), after = seen(time + h);
    const SwingState a = leg.hanging(before), b = leg.hanging(at), c = leg.hanging(after);
    state = {b.thigh, b.shank, (c.thigh - a.thigh) * (0.5F * per), (c.shank - a.shank) * (0.5F * per)};
    pull = pulled(before, at, after, per2);
    torque = leg.torques(state, (a.thigh - 2.0F * b.thigh + c.thigh) * per2,
                         (a.shank - 2.0F * b.shank + c.shank) * per2, pull);
  };
  OtherLeg around[3];
  const Wide per = 1.0F / out.apart_s;
  for (std::size_t i = 0; i <= last; ++i) {
    OtherLeg& now = around[i % 3];
    const Wide time = fma(wide(static_cast<float>(i)), out.apart_s, from);
    now = seen(time);
    out.part[i] = now.part;
    if (i == 0)
      end(time, now, out.at[i], out.pull[i], out.off);
    else if (i == last)
      end(time, now, out.at[i], out.pull[i], out.on);
    else
      out.at[i] = leg.hanging(now);
    if (i > 1) out.pull[i - 1] = pulled(around[(i - 2) % 3], around[(i - 1) % 3], now, per * per);
  }
  for (std::size_t i = 1; i < last; ++i) {
    SwingState& y = out.at[i];
    y.thigh_rate = (out.at[i + 1].thigh - out.at[i - 1].thigh) * (0.5F * per);
    y.shank_rate = (out.at[i + 1].shank - out.at[i - 1].shank) * (0.5F * per);
  }
  out.parts_off = torque_parts(0, out.at[0]);
  out.parts_on = torque_parts(last, out.at[last]);
}

/// Computes the deviation of an integrated ankle path from the step's, in body heights: a bump times polynomials.
HWY_NOINLINE inline void as_bumps(const SwingLeg& leg, const SwingToMeet& swing,
                                  const SwingState (&way)[swing_steps + 1], Wide (&forward)[other_way_count],
                                  Wide (&up)[other_way_count]) {
  LeastSquares<other_way_count> fit({1e-6F, 1e-6F, 1e-6F, 1e-6F, 1e-6F});
  for (auto& number : up) number = wide(0.0F);
  for (std::size_t i = 1; i < swing_steps; ++i) {
    const AnkleBelow is(leg, way[i]), was(leg, swing.at[2 * i]);
    const Wide x = 2.0F * swing.part[2 * i] - 1.0F, b = bump(swing.part[2 * i]);
    Wide row[other_way_count] = {b, b * x};
    for (std::size_t k = 2; k < other_way_count; ++k) {
      const auto degree = static_cast<float>(k);
      row[k] = (x * row[k - 1]) * ((2 * degree - 1) / degree) - row[k - 2] * ((degree - 1) / degree);
    }
    fit.ask(row, is.forward - was.forward);
    for (std::size_t k = 0; k < other_way_count; ++k) up[k] = fma(row[k], is.up - was.up, up[k]);
  }
  fit.solve();
  fit.normal.solve(up);
  for (std::size_t k = 0; k < other_way_count; ++k) forward[k] = fit.sum[k];
}

/// Maximum error at heel strike (rad) and maximum correction (of the height) of an integrated swing. Above them the
/// swing stays unchanged.
constexpr float max_miss = 0.03F, max_moved = 0.1F;

/// Chooses plan.swing_by_forward_m and swing_by_up_m: deviation of a forward-integrated swing from the curves of the
/// shape. `share` is its weight. With 0 the swing stays unchanged.
HWY_NOINLINE inline void integrate_swing(const LegSize& size, const Wide& share, StepPlan<Lanes<float>>& plan) {
  constexpr SwingLeg leg = unit_swing_leg;
  SwingToMeet swing;
  Wide first[torque_count], number[torque_count];
  swing_to_meet(plan, leg, size, swing);
  first_numbers(leg, swing, first);
  for (std::size_t k = 0; k < torque_count; ++k) number[k] = first[k];
  SwingState way[swing_steps + 1];
  constexpr int rounds = 3;  // the third lands within 0.3°
  for (int round = 0; round < rounds; ++round) swing_forward(leg, swing, first, number, way);
  Wide forward[other_way_count], up[other_way_count];
  as_bumps(leg, swing, way, forward, up);
  const SwingState &landed = way[swing_steps], &meant = swing.at[swing_instants - 1];
  WideMask sound =
      (share > 0.0F) & (abs(landed.thigh - meant.thigh) < max_miss) & (abs(landed.shank - meant.shank) < max_miss);
  for (std::size_t k = 0; k < other_way_count; ++k)
    sound = sound & (abs(forward[k]) < max_moved) & (abs(up[k]) < max_moved);
  for (std::size_t k = 0; k < other_way_count; ++k) {
    store(select(sound, share * size.leg * forward[k], wide(0.0F)), plan.swing_by_forward_m[k]);
    store(select(sound, share * size.leg * up[k], wide(0.0F)), plan.swing_by_up_m[k]);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
