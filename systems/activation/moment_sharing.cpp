#include "systems/activation/moment_sharing.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>

#include "engine/wide_geometry-inl.h"
#include "systems/activation/hill_curves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace {

constexpr int rounds = 3, steps_from_nowhere = 32, refining_steps = 12;
constexpr float litre_of_force_and_length = 300;  // N · m, at 30 N/cm²
/// size² / volume of the reserves, N² m² / l.
constexpr float hip_yields = 80.0F * 80.0F / 0.67F, other_yields = 1;

struct Three {
  Wide x, y, z;
};
HWY_INLINE Wide dot(const Three& a, const Three& b) {
  return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
HWY_INLINE Three fma_three(const Wide& s, const Three& a, const Three& b) {
  return {fma(s, a.x, b.x), fma(s, a.y, b.y), fma(s, a.z, b.z)};
}
HWY_INLINE Three loaded(const LegMoments<Lanes<float>>& m) {
  return {load(m.hip), load(m.knee), load(m.ankle)};
}
HWY_INLINE Three chosen(const WideMask& mask, const Three& a, const Three& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Symmetric and positive definite.
struct Symmetric {
  Wide xx, xy, xz, yy, yz, zz;
};
HWY_INLINE Three solved(const Symmetric& s, const Three& b) {
  const Wide over_x = wide(1.0F) / s.xx, l_y = s.xy * over_x, l_z = s.xz * over_x;
  const Wide d_y = fnma(l_y, s.xy, s.yy), over_y = wide(1.0F) / d_y, m_z = fnma(l_y, s.xz, s.yz);
  const Wide k_z = m_z * over_y, d_z = fnma(k_z, m_z, fnma(l_z, s.xz, s.zz));
  const Wide y = fnma(l_y, b.x, b.y), z = fnma(k_z, y, fnma(l_z, b.x, b.z));
  const Wide third = z / d_z, second = fnma(k_z, third, y * over_y);
  return {fnma(l_y, second, fnma(l_z, third, b.x * over_x)), second, third};
}

/// A member in one round: force at full activation, and activation per arm · y, which is that force over the volume.
struct Pull {
  Wide active, per_y;
};

HWY_INLINE Wide in_range(const Wide& x) {
  return min(max(x, wide(min_activation)), wide(max_activation));
}

/// Returns the step, shortened so that no activation changes by more than `most`.
HWY_INLINE Three shortened(const Three& step, const Wide& most, const Pull* pull, const Three* arm) {
  Wide farthest = most;
  for (std::size_t i = 0; i < leg_member_count; ++i) farthest = max(farthest, abs(pull[i].per_y * dot(arm[i], step)));
  const Wide part = most / farthest;
  return {part * step.x, part * step.y, part * step.z};
}

/// The dual at y: its value, which is minimal where no moment is left; the moments left, which are its downhill slope;
/// and how fast they decrease with y.
struct Dual {
  Wide value;
  Three left;
  Symmetric slope;
};
HWY_INLINE Dual dual_at(const Three& y, const Three& moments, const Pull* pull, const Three* arm) {
  const Wide zero = wide(0.0F);
  const Three reserve = {hip_yields * y.x, y.y, y.z};
  Dual at{0.5F * dot(reserve, y) - dot(moments, y),
          {moments.x - reserve.x, moments.y - reserve.y, moments.z - reserve.z},
          {wide(hip_yields), zero, zero, wide(other_yields), zero, wide(other_yields)}};
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    const Wide along = dot(arm[i], y), wanted = pull[i].per_y * along, a = in_range(wanted);
    const Wide force = a * pull[i].active;
    at.value = fma(force, fnma(wide(0.5F), a / pull[i].per_y, along), at.value);
    at.left = fma_three(-force, arm[i], at.left);
    const WideMask free = (wanted > wide(min_activation)) & (wanted < wide(max_activation));
    const Wide k = select(free, pull[i].per_y * pull[i].active, zero);
    const Three scaled = {k * arm[i].x, k * arm[i].y, k * arm[i].z};
    at.slope.xx = fma(scaled.x, arm[i].x, at.slope.xx);
    at.slope.xy = fma(scaled.x, arm[i].y, at.slope.xy);
    at.slope.xz = fma(scaled.x, arm[i].z, at.slope.xz);
    at.slope.yy = fma(scaled.y, arm[i].y, at.slope.yy);
    at.slope.yz = fma(scaled.y, arm[i].z, at.slope.yz);
    at.slope.zz = fma(scaled.z, arm[i].z, at.slope.zz);
  }
  return at;
}

/// Returns the y at which no moment is left.
HWY_INLINE Three solve_dual(const Three& from, const Three& moments, const Pull* pull, const Three* arm, int steps) {
  const Wide zero = wide(0.0F);
  Three y = from;
  const Dual first = dual_at(y, moments, pull, arm);
  Wide least = first.value, reach = wide(1.0F);
  Three step = shortened(solved(first.slope, first.left), reach, pull, arm);
  for (int i = 0; i < steps; ++i) {
    const Three next = {y.x + step.x, y.y + step.y, y.z + step.z};
    const Dual at = dual_at(next, moments, pull, arm);
    // Near the end values differ only by rounding, but steps are small by then.
    const WideMask better = at.value <= fma(wide(1e-6F), abs(least), least);
    y = chosen(better, next, y);
    least = select(better, at.value, least);
    // If all muscles are at an end of their range, only the reserves determine the slope, and steps are far too long.
    // If the muscles stay there in the solution, such long steps are needed.
    reach = select(better, min(4.0F * reach, wide(1e6F)), reach * 0.4F);
    const Three shorter = {0.4F * step.x, 0.4F * step.y, 0.4F * step.z};
    step = chosen(better, shortened(solved(at.slope, at.left), reach, pull, arm), shorter);
  }
  const WideMask number = (least >= zero) | (least < zero);
  return chosen(number, y, Three{zero, zero, zero});
}

}  // namespace

void share_all(const LegDesign<Lanes<float>>& design, const Lanes<float>* path_m, const LegMoments<Lanes<float>>* arm_m,
               const LegMoments<Lanes<float>>& moments_nm, Lanes<float>* of_most, LegMoments<Lanes<float>>& reserve_nm,
               Lanes<std::uint32_t>& at_most) {
  const Wide zero = wide(0.0F), one = wide(1.0F);
  Three arm[leg_member_count];
  Wide force[leg_member_count], asked[leg_member_count];  // of the isometric one
  for (std::size_t i = 0; i < leg_member_count; ++i) arm[i] = loaded(arm_m[i]), force[i] = wide(0.2F);
  Pull pull[leg_member_count];
  Three y = {zero, zero, zero};
  Wide full = zero;
  for (int round = 0; round < rounds; ++round) {
    Three moments = loaded(moments_nm);
    Wide passive[leg_member_count];
    for (std::size_t i = 0; i < leg_member_count; ++i) {
      const MemberDesign<Lanes<float>>& of = design.member[i];
      const Wide fibre = load(of.fibre_m), over = one / fibre, most = load(of.force_n),
                 height = over * load(of.height_m);
      const Wide m = fibre_at(height, over * load(of.tendon_m), over * load(path_m[i]), force[i]);
      const Wide cos = fibre_cosine(height / m);
      passive[i] = most * passive_force(m).at * cos;
      pull[i].active = most * active_force(m).at * cos;
      pull[i].per_y = pull[i].active * wide(litre_of_force_and_length) / (most * fibre);
      moments = fma_three(-passive[i], arm[i], moments);
    }
    y = solve_dual(y, moments, pull, arm, round == 0 ? steps_from_nowhere : refining_steps);
    full = zero;
    for (std::size_t i = 0; i < leg_member_count; ++i) {
      const Wide wanted = pull[i].per_y * dot(arm[i], y);
      asked[i] = fma(in_range(wanted), pull[i].active, passive[i]) / load(design.member[i].force_n);
      force[i] = 0.5F * (force[i] + asked[i]);  // undamped rounds oscillate: a longer tendon weakens the fibre
      full = full + select(wanted >= wide(max_activation), one, zero);
    }
  }
  Three left = loaded(moments_nm);
  for (std::size_t i = 0; i < leg_member_count; ++i) {
    store(asked[i], of_most[i]);
    left = fma_three(-asked[i] * load(design.member[i].force_n), arm[i], left);
  }
  store(left.x, reserve_nm.hip);
  store(left.y, reserve_nm.knee);
  store(left.z, reserve_nm.ankle);
  Lanes<float> count;
  store(full, count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) at_most[lane] = static_cast<std::uint32_t>(count[lane]);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace mobil::inline v0_3 {
namespace {
HWY_EXPORT(share_all);
}  // namespace

void share_moments(const LegDesign<Lanes<float>>& design, const Lanes<float>* path_m,
                   const LegMoments<Lanes<float>>* arm_m, const LegMoments<Lanes<float>>& moments_nm,
                   Lanes<float>* of_most, LegMoments<Lanes<float>>& reserve_nm, Lanes<std::uint32_t>& at_most) {
  HWY_DYNAMIC_DISPATCH(share_all)(design, path_m, arm_m, moments_nm, of_most, reserve_nm, at_most);
}

}  // namespace mobil::inline v0_3
#endif
