#include "systems/activation/moment_sharing.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide_geometry-inl.h"
#include "systems/activation/hill_curves-inl.h"

#ifndef MOBIL_SYSTEMS_ACTIVATION_MOMENT_SHARING_CPP_
#define MOBIL_SYSTEMS_ACTIVATION_MOMENT_SHARING_CPP_
namespace mobil::inline v0_3 {
namespace {
// Riener & Edrich 1999: exponents c₀ + c₁ · knee + c₂ · hip, degrees of flexion; N m.
constexpr float front_of_hip[3] = {1.4655F, -0.0034F, -0.0750F}, back_of_hip[3] = {1.3403F, -0.0226F, 0.0305F};
constexpr float passive_hip_at_rest = 8.072F, degrees = 57.2957795F;
}  // namespace
}  // namespace mobil::inline v0_3
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

constexpr std::size_t moment_count = leg_moment_count;
constexpr int newton_steps = 16;
constexpr float at_an_end = 0.01F;
constexpr float litre_of_force_and_length = 300;  // N · m, at 30 N/cm²
/// size² / volume of the reserves, N² m² / l.
constexpr float yield = 4;

struct Moments {
  Wide of[moment_count];
};
static_assert(sizeof(LegMoments<Lanes<float>>) == moment_count * sizeof(Lanes<float>));

HWY_INLINE Moments loaded(const LegMoments<Lanes<float>>& m) {
  const auto* const from = reinterpret_cast<const Lanes<float>*>(&m);
  Moments to;
  for (std::size_t k = 0; k < moment_count; ++k) to.of[k] = load(from[k]);
  return to;
}
HWY_INLINE void store_moments(const Moments& from, LegMoments<Lanes<float>>& to) {
  auto* const words = reinterpret_cast<Lanes<float>*>(&to);
  for (std::size_t k = 0; k < moment_count; ++k) store(from.of[k], words[k]);
}
HWY_INLINE Wide dot(const Moments& a, const Moments& b) {
  Wide sum = a.of[0] * b.of[0];
  for (std::size_t k = 1; k < moment_count; ++k) sum = fma(a.of[k], b.of[k], sum);
  return sum;
}
HWY_INLINE Moments scaled(const Wide& s, const Moments& a) {
  Moments to;
  for (std::size_t k = 0; k < moment_count; ++k) to.of[k] = s * a.of[k];
  return to;
}
HWY_INLINE Moments chosen(const WideMask& mask, const Moments& a, const Moments& b) {
  Moments to;
  for (std::size_t k = 0; k < moment_count; ++k) to.of[k] = select(mask, a.of[k], b.of[k]);
  return to;
}
HWY_INLINE void add_scaled(const Wide& s, const Moments& a, Moments& to) {
  for (std::size_t k = 0; k < moment_count; ++k) to.of[k] = fma(s, a.of[k], to.of[k]);
}

/// Symmetric and positive definite; row r has its entries from the diagonal on.
struct Symmetric {
  Wide entry[moment_count][moment_count];
};

/// Solves by LDLᵀ.
HWY_INLINE Moments solved(Symmetric s, const Moments& b) {
  Moments x = b;
  for (std::size_t k = 0; k < moment_count; ++k) {
    const Wide over = wide(1.0F) / s.entry[k][k];
    for (std::size_t r = k + 1; r < moment_count; ++r) {
      const Wide factor = s.entry[k][r] * over;
      for (std::size_t c = r; c < moment_count; ++c) s.entry[r][c] = fnma(factor, s.entry[k][c], s.entry[r][c]);
      x.of[r] = fnma(factor, x.of[k], x.of[r]);
    }
  }
  for (std::size_t k = moment_count; k-- > 0;) {
    for (std::size_t c = k + 1; c < moment_count; ++c) x.of[k] = fnma(s.entry[k][c], x.of[c], x.of[k]);
    x.of[k] = x.of[k] / s.entry[k][k];
  }
  return x;
}

/// Returns the flexing moment of the hip's passive tissue, which grows with the cube of the size.
HWY_INLINE Wide passive_hip(const Wide& hip_rad, const Wide& knee_rad, const Wide& size) {
  const Wide hip = hip_rad * degrees, knee = knee_rad * degrees;
  const auto tissue = [&](const float(&c)[3]) { return exp(fma(hip, wide(c[2]), fma(knee, wide(c[1]), wide(c[0])))); };
  return size * size * size * (tissue(front_of_hip) - tissue(back_of_hip) + passive_hip_at_rest);
}

/// A line: arms, force at full activation, and activation per arm · y, which is that force over the volume.
struct Pull {
  Moments arm;
  Wide active, per_y;
};

HWY_INLINE Wide in_range(const Wide& x) {
  return min(max(x, wide(min_activation)), wide(max_activation));
}

/// Returns the step, shortened so that no activation changes by more than `most`.
HWY_INLINE Moments shortened(const Moments& step, const Wide& most, const Pull* pull) {
  Wide farthest = most;
  for (std::size_t i = 0; i < leg_member_count; ++i)
    farthest = max(farthest, abs(pull[i].per_y * dot(pull[i].arm, step)));
  return scaled(most / farthest, step);
}

/// The dual at y: its value, which is minimal where no moment is left; the moments left, which are its downhill slope;
/// and how fast they decrease with y.
struct Dual {
  Wide value;
  Moments left;
  Symmetric slope;
};
HWY_NOINLINE void dual_at(const Moments& y, const Moments& moments, const Pull* pull, Dual& at) {
  const Wide zero = wide(0.0F);
  at.value = zero;
  for (std::size_t k = 0; k < moment_count; ++k) {
    const Wide reserve = yield * y.of[k];
    at.value = fma(y.of[k], 0.5F * reserve - moments.of[k], at.value);
    at.left.of[k] = moments.of[k] - reserve;
    for (std::size_t c = k; c < moment_count; ++c) at.slope.entry[k][c] = c == k ? wide(yield) : zero;
  }
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    const Pull& of = pull[i];
    const Wide along = dot(of.arm, y), wanted = of.per_y * along, a = in_range(wanted);
    const Wide force = a * of.active;
    at.value = fma(force, fnma(wide(0.5F), a / of.per_y, along), at.value);
    const WideMask free = (wanted > wide(min_activation)) & (wanted < wide(max_activation));
    // A little slope of muscles at an end of their range keeps steps short that would leave it.
    const Wide own_slope = of.per_y * of.active, stiff = select(free, own_slope, at_an_end * own_slope);
    for (std::size_t k = 0; k < moment_count; ++k) {
      at.left.of[k] = fnma(force, of.arm.of[k], at.left.of[k]);
      const Wide own = stiff * of.arm.of[k];
      for (std::size_t c = k; c < moment_count; ++c)
        at.slope.entry[k][c] = fma(own, of.arm.of[c], at.slope.entry[k][c]);
    }
  }
}

/// Returns the y at which no moment is left, from one near it.
HWY_INLINE Moments solve_dual(const Moments& from, const Moments& moments, const Pull* pull) {
  const Wide zero = wide(0.0F);
  Moments y = from;
  Dual at;
  dual_at(y, moments, pull, at);
  Wide least = at.value, reach = wide(1.0F);
  Moments step = shortened(solved(at.slope, at.left), reach, pull);
  for (int i = 0; i < newton_steps; ++i) {
    Moments next = y;
    add_scaled(wide(1.0F), step, next);
    dual_at(next, moments, pull, at);
    // Near the end values differ only by rounding, but steps are small by then.
    const WideMask better = at.value <= fma(wide(1e-6F), abs(least), least);
    y = chosen(better, next, y);
    least = select(better, at.value, least);
    // If all muscles are at an end of their range, steps are far too long. If the muscles stay there in the solution,
    // such long steps are needed.
    reach = select(better, min(6.0F * reach, wide(1e6F)), reach * 0.25F);
    step = chosen(better, shortened(solved(at.slope, at.left), reach, pull), scaled(wide(0.25F), step));
  }
  const WideMask number = (least >= zero) | (least < zero);
  return chosen(number, y, Moments{{zero, zero, zero, zero, zero}});
}

}  // namespace

void share_all(const LegDesign<Lanes<float>>& design, const SharedLeg& leg, const LegMoments<Lanes<float>>& moments_nm,
               LegMoments<Lanes<float>>& price, Lanes<float>* smooth_of_most, Lanes<float>* of_most,
               LegMoments<Lanes<float>>& left_nm, Lanes<std::uint32_t>& at_most) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  Wide passive[leg_member_count];
  Pull pull[leg_member_count];
  Moments moments = loaded(moments_nm);
  moments.of[0] = moments.of[0] + passive_hip(load(leg.flexion_rad.hip), load(leg.flexion_rad.knee), load(leg.size));
  Moments left = moments;
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    const MemberDesign<Lanes<float>>& of = design.member[i];
    const Wide fibre = load(of.fibre_m), over = one / fibre, most = load(of.force_n), height = over * load(of.height_m);
    const Wide m =
        fibre_at(height, over * load(of.tendon_m), over * load(leg.path_m[i]), max(load(smooth_of_most[i]), zero));
    const Wide cos = fibre_cosine(height / m);
    passive[i] = most * passive_force(m).at * cos;
    pull[i].arm = loaded(leg.arm_m[i]);
    pull[i].active = most * active_force(m).at * cos;
    pull[i].per_y = pull[i].active * wide(litre_of_force_and_length) / (most * fibre);
    add_scaled(-passive[i], pull[i].arm, moments);
  }
  const Moments y = solve_dual(loaded(price), moments, pull);
  Wide full = zero;
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    const Wide wanted = pull[i].per_y * dot(pull[i].arm, y);
    const Wide force = fma(in_range(wanted), pull[i].active, passive[i]);
    const Wide asked = force / load(design.member[i].force_n);
    add_scaled(-force, pull[i].arm, left);
    full = full + select(wanted >= wide(max_activation), one, zero);
    store(asked, of_most[i]);
    // Undamped lengths oscillate: a longer tendon weakens the fibre.
    const Wide smooth = 0.5F * (load(smooth_of_most[i]) + asked);
    store(select((smooth >= zero) | (smooth < zero), smooth, zero), smooth_of_most[i]);
  }
  store_moments(y, price);
  store_moments(left, left_nm);
  Lanes<float> count;
  store(full, count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) at_most[lane] = static_cast<std::uint32_t>(count[lane]);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>

namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(share_all);
}  // namespace

double passive_hip_nm(double hip_flexion_rad, double knee_flexion_rad) {
  const double hip = hip_flexion_rad * double{degrees}, knee = knee_flexion_rad * double{degrees};
  const auto tissue = [&](const float(&c)[3]) {
    return std::exp(double{c[0]} + double{c[1]} * knee + double{c[2]} * hip);
  };
  return tissue(front_of_hip) - tissue(back_of_hip) + double{passive_hip_at_rest};
}

void share_moments(const LegDesign<Lanes<float>>& design, const SharedLeg& leg,
                   const LegMoments<Lanes<float>>& moments_nm, LegMoments<Lanes<float>>& price,
                   Lanes<float>* smooth_of_most, Lanes<float>* of_most, LegMoments<Lanes<float>>& left_nm,
                   Lanes<std::uint32_t>& at_most) {
  HWY_DYNAMIC_DISPATCH(share_all)(design, leg, moments_nm, price, smooth_of_most, of_most, left_nm, at_most);
}

}  // namespace mobil::inline v0_3
#endif
