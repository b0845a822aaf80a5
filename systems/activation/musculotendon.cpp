#include "systems/activation/musculotendon.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide_geometry-inl.h"
#include "systems/activation/hill_curves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

constexpr float fastest_per_s = 10, fibre_damping = 0.1F;
constexpr float slow_rate = 9;  // 1/90 s
constexpr int steps_from_nearby = 4, steps_from_anywhere = 24;

/// Slope of force over speed at rest: 0.32113 · 8.149 / √(1 + 0.374²).
constexpr float slope_at_rest = 2.4511F;

/// One member, with fibres of optimal length 1.
struct Fibre {
  Wide height, tendon, path;  // height, slack length of the tendon and length of the path over the optimal length
  Wide over_tendon;           // 1 / tendon
  Wide activation;
};

HWY_INLINE Wide cosine(const Fibre& of, const Wide& m) {
  return fibre_cosine(of.height / m);
}

/// Returns the fibre's pull minus the tendon's at length m, and its slope. The slope is positive except on the falling
/// side of the active force at rest, where the bracket decides. `rate` is the speed over the maximum speed, per length.
HWY_INLINE CurvePoint pull(const Fibre& of, const Wide& m, const Wide& before, const Wide& rate) {
  const Wide speed = (m - before) * rate;
  const CurvePoint active = active_force(m), passive = passive_force(m), by_speed = force_at_speed(speed);
  const Wide over_m = wide(1.0F) / m, cos = fibre_cosine(of.height * over_m), over_cos = wide(1.0F) / cos;
  const CurvePoint tendon = tendon_force(fnma(m, cos, of.path) * of.over_tendon);
  const Wide fibre = fma(of.activation * active.at, by_speed.at, fma(wide(fibre_damping), speed, passive.at));
  const Wide stiffness = fma(of.activation, fma(active.slope, by_speed.at, active.at * by_speed.slope * rate),
                             fma(wide(fibre_damping), rate, passive.slope));
  // d cos α / dm = (1 / cos α − cos α) / m; d(m cos α)/dm = 1 / cos α
  const Wide turning = fibre * (over_cos - cos) * over_m;
  return {fma(fibre, cos, -tendon.at), fma(stiffness, cos, fma(tendon.slope * of.over_tendon, over_cos, turning))};
}

/// Returns the fibre's length, starting from `before`. The first guess moves toward the length at which the tendon
/// balances the present pull. It moves farther the stiffer the tendon is compared with the resistance to speed, and all
/// the way in a long tick. From a stretched tendon, Newton steps would be short: its force grows steeply.
HWY_INLINE Wide solve(const Fibre& of, const Wide& before, float rate_per_length, int steps) {
  const Wide zero = wide(0.0F), rate = wide(rate_per_length);
  Wide low = shortest_fibre(of.height), high = wide(longest_fibre);
  const Wide from = select((before > low) & (before < high), before, 0.5F * (low + high));
  const Wide active = of.activation * active_force(from).at, cos = cosine(of, from);
  const Wide force = fma(cos, active, cos * min(passive_force(from).at, 1.0F));
  const Wide balanced = fibre_at(of.height, of.tendon, of.path, force);
  const Wide tendon = tendon_force(fnma(from, cos, of.path) * of.over_tendon).at;
  // Force lost to speed per length, by the slope of resting fibres, and force that the tendon gains over the whole way.
  const Wide costs = rate * fma(active, wide(slope_at_rest), wide(fibre_damping)) * abs(balanced - from);
  const Wide gains = abs(tendon - force);
  const bool slow = rate_per_length < slow_rate;
  Wide m = slow ? balanced : fma(gains / max(gains + costs, wide(1e-9F)), balanced - from, from);
  for (int i = 0; i < steps; ++i) {
    const CurvePoint left = pull(of, m, before, rate);
    const WideMask too_long = left.at > zero;
    high = select(too_long, m, high);
    low = select(too_long, low, m);
    const Wide next = m - left.at / left.slope;
    m = select((next >= low) & (next <= high), next, 0.5F * (low + high));
  }
  return m;
}

HWY_INLINE Wide risen(const Wide& activation, const Wide& excitation, float tick_s) {
  const Wide by = fma(activation, wide(1.5F), wide(0.5F));
  const Wide per_s = select(excitation > activation, 100.0F / by, 25.0F * by);
  const Wide part = wide(1.0F) - exp(-tick_s * per_s);
  return fma(part, excitation - activation, activation);
}

/// Clamps an activation. NaN becomes the minimum, so the lane recovers.
HWY_INLINE Wide within_range(const Wide& x) {
  return select(x > wide(min_activation), min(x, max_activation), wide(min_activation));
}

struct Sums {
  Wide excitation, activation, fibre, tendon, pennation, force, belly, slack;
};

HWY_INLINE void add(const MemberDesign<Lanes<float>>& design, const Fibre& fibre, const Wide& path, const Wide& m,
                    float weight, Sums& to) {
  const Wide share = wide(weight), optimal = load(design.fibre_m);
  const Wide cos = cosine(fibre, m), length = optimal * m;
  const Wide tendon = fnma(length, cos, path);
  const Wide stretch = tendon / load(design.tendon_m);
  to.activation = fma(share, fibre.activation, to.activation);
  to.fibre = fma(share, length, to.fibre);
  to.tendon = fma(share, tendon, to.tendon);
  to.pennation = fma(share, atan2(fibre.height, m * cos), to.pennation);
  to.force = fma(load(design.force_n), max(tendon_force(stretch).at, wide(0.0F)), to.force);
  to.belly = fma(share, fma(length, cos, -load(design.rest_belly_m)), to.belly);
  to.slack = to.slack + select(stretch < 1.0F, wide(1.0F), wide(0.0F));
}

HWY_INLINE Fibre fibre_of(const MemberDesign<Lanes<float>>& design, const Wide& path) {
  const Wide optimal = load(design.fibre_m), slack = load(design.tendon_m), over = wide(1.0F) / optimal;
  return {over * load(design.height_m), over * slack, over * path, optimal / slack, wide(min_activation)};
}

/// Advances all members by `tick_s`, or sets them to rest if it is 0.
HWY_INLINE void contract_members(const MemberBlock& of, float tick_s, Activation<Lanes<float>>& activation,
                                 Musculotendon<Lanes<float>>& muscle) {
  const Wide zero = wide(0.0F);
  Sums sum{zero, zero, zero, zero, zero, zero, zero, zero};
  for (std::size_t i = 0; i < of.members; ++i) {
    const Wide path = load(of.length_m[i]);
    Fibre fibre = fibre_of(of.design[i], path);
    const Wide excitation = within_range(load(of.excitation[i]));
    const bool moves = tick_s > 0;
    fibre.activation = moves ? within_range(risen(load(of.state[i].activation), excitation, tick_s)) : excitation;
    const float rate = moves ? 1 / (fastest_per_s * tick_s) : 0;
    const Wide m = solve(fibre, load(of.state[i].fibre), rate, moves ? steps_from_nearby : steps_from_anywhere);
    store(fibre.activation, of.state[i].activation);
    store(m, of.state[i].fibre);
    sum.excitation = fma(wide(of.weight[i]), excitation, sum.excitation);
    add(of.design[i], fibre, path, m, of.weight[i], sum);
  }
  store(sum.excitation, activation.excitation);
  store(sum.activation, activation.activation);
  store(sum.fibre, muscle.fibre_m);
  store(sum.tendon, muscle.tendon_m);
  store(sum.pennation, muscle.pennation_rad);
  store(sum.force, muscle.force_n);
  store(sum.belly, muscle.belly_m);
  Lanes<float> slack;
  store(sum.slack, slack);
  for (std::size_t lane = 0; lane < lane_count; ++lane) muscle.slack[lane] = static_cast<std::uint32_t>(slack[lane]);
}

}  // namespace

void contract_all(const MemberBlock& of, float tick_s, Activation<Lanes<float>>& activation,
                  Musculotendon<Lanes<float>>& muscle) {
  contract_members(of, tick_s, activation, muscle);
}

void activate_for(const MemberBlock& of, const Lanes<float>* of_most, float tick_s, Lanes<float>* excitation) {
  const Wide rate = wide(1 / (fastest_per_s * tick_s));
  for (std::size_t i = 0; i < of.members; ++i) {
    const Fibre fibre = fibre_of(of.design[i], load(of.length_m[i]));
    const Wide force = max(load(of_most[i]), wide(0.0F));
    const Wide m = fibre_at(fibre.height, fibre.tendon, fibre.path, force), cos = cosine(fibre, m);
    const Wide speed = (m - load(of.state[i].fibre)) * rate;
    // Fibres with almost no requested force need not keep up with a tendon that goes slack.
    const Wide drag = max(fibre_damping * speed, -force), by_speed = max(force_at_speed(speed).at, wide(0.25F));
    const Wide asked = within_range((force / cos - passive_force(m).at - drag) / (active_force(m).at * by_speed));
    store(asked, excitation[i]);
  }
}

void find_rests(std::size_t members, const Lanes<float>* length_m, MemberDesign<Lanes<float>>* design) {
  for (std::size_t i = 0; i < members; ++i) {
    const Wide path = load(length_m[i]);
    const Fibre fibre = fibre_of(design[i], path);
    const Wide m = solve(fibre, wide(1.0F), 0, steps_from_anywhere);
    store(load(design[i].fibre_m) * m * cosine(fibre, m), design[i].rest_belly_m);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(contract_all);
HWY_EXPORT(activate_for);
HWY_EXPORT(find_rests);
}  // namespace

void contract(const MemberBlock& of, float tick_s, Activation<Lanes<float>>& activation,
              Musculotendon<Lanes<float>>& muscle) {
  HWY_DYNAMIC_DISPATCH(contract_all)(of, tick_s, activation, muscle);
}

void settle(const MemberBlock& of, Activation<Lanes<float>>& activation, Musculotendon<Lanes<float>>& muscle) {
  HWY_DYNAMIC_DISPATCH(contract_all)(of, 0, activation, muscle);
}

void ask_forces(const MemberBlock& of, const Lanes<float>* of_most, float tick_s, Lanes<float>* excitation) {
  HWY_DYNAMIC_DISPATCH(activate_for)(of, of_most, tick_s, excitation);
}

void find_rest_bellies(std::size_t members, const Lanes<float>* length_m, MemberDesign<Lanes<float>>* design) {
  HWY_DYNAMIC_DISPATCH(find_rests)(members, length_m, design);
}

}  // namespace mobil::inline v0_3
#endif
