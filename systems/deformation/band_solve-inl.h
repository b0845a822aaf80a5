// Forward and backward half of a banded solution with one factor for all lanes, one register of lanes at a time. For
// inclusion only inside Highway's targets.

#if defined(MOBIL_SYSTEMS_DEFORMATION_BAND_SOLVE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_DEFORMATION_BAND_SOLVE_INL_H_
#undef MOBIL_SYSTEMS_DEFORMATION_BAND_SOLVE_INL_H_
#else
#define MOBIL_SYSTEMS_DEFORMATION_BAND_SOLVE_INL_H_
#endif

#include "assets/fem/belly_solver.h"
#include "engine/fused-inl.h"
#include "systems/deformation/elastic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

HWY_INLINE Vector load_vector(const float* p) {
  return {hn::Load(d, p), hn::Load(d, p + lane_count), hn::Load(d, p + 2 * lane_count)};
}
HWY_INLINE void store_vector(const Vector& a, float* p) {
  hn::Store(a.x, d, p);
  hn::Store(a.y, d, p + lane_count);
  hn::Store(a.z, d, p + 2 * lane_count);
}

/// Returns ∑ block·(node's vector) over `count` nodes from `p` on, with `p` advancing by `stride`. Blocks are 3×3, or
/// single numbers with one component. `block` advances past them.
template <std::uint32_t components>
HWY_INLINE Vector sum_couplings(std::uint32_t count, const float* p, std::ptrdiff_t stride, const float*& block) {
  const float* q = block;
  const V none = hn::Zero(d);
  const auto add = [&q](std::size_t word, V value, V sum) HWY_ATTR { return mul_add(hn::Set(d, q[word]), value, sum); };
  if constexpr (components == 3) {
    V s0 = none, s1 = none, s2 = none, s3 = none, s4 = none, s5 = none, s6 = none, s7 = none, s8 = none;
    for (std::uint32_t m = 0; m < count; ++m, p += stride, q += 9) {
      const V x = load_once(p), y = load_once(p + lane_count), z = load_once(p + 2 * lane_count);
      s0 = add(0, x, s0);
      s1 = add(3, x, s1);
      s2 = add(6, x, s2);
      s3 = add(1, y, s3);
      s4 = add(4, y, s4);
      s5 = add(7, y, s5);
      s6 = add(2, z, s6);
      s7 = add(5, z, s7);
      s8 = add(8, z, s8);
    }
    block = q;
    return {hn::Add(hn::Add(s0, s3), s6), hn::Add(hn::Add(s1, s4), s7), hn::Add(hn::Add(s2, s5), s8)};
  } else {
    V s0 = none, s1 = none, s2 = none, s3 = none, s4 = none, s5 = none;
    std::uint32_t m = count % 2;
    if (m == 1) {
      s0 = add(0, hn::Load(d, p), s0);
      s1 = add(0, hn::Load(d, p + lane_count), s1);
      s2 = add(0, hn::Load(d, p + 2 * lane_count), s2);
      p += stride;
      q += 1;
    }
    for (; m < count; m += 2, p += 2 * stride, q += 2) {
      const float* const next = p + stride;
      s0 = add(0, hn::Load(d, p), s0);
      s1 = add(0, hn::Load(d, p + lane_count), s1);
      s2 = add(0, hn::Load(d, p + 2 * lane_count), s2);
      s3 = add(1, hn::Load(d, next), s3);
      s4 = add(1, hn::Load(d, next + lane_count), s4);
      s5 = add(1, hn::Load(d, next + 2 * lane_count), s5);
    }
    block = q;
    return {hn::Add(s0, s3), hn::Add(s1, s4), hn::Add(s2, s5)};
  }
}

/// Solves G·y = r node by node. `right(n)` returns r, and `y` is written from the factor's first node on. n counts from
/// that node. Returns |y|².
template <std::uint32_t components, class Right>
HWY_INLINE V solve_forward(const BandFactor& factor, float* y, Right&& right) {
  const float* block = factor.forward.data();
  const float* own = factor.inverse_diagonal.data();
  V square = hn::Zero(d);
  for (std::uint32_t n = 0; n < factor.nodes; ++n) {
    const std::uint32_t count = factor.before[n];
    float* const at = y + node_stride * n;
    const Vector sum = sum_couplings<components>(count, at - node_stride * count, node_stride, block);
    const Vector r = right(n);
    const Vector left{hn::Sub(r.x, sum.x), hn::Sub(r.y, sum.y), hn::Sub(r.z, sum.z)};
    const auto word = [own](std::size_t w) HWY_ATTR { return hn::Set(d, own[w]); };
    Vector solved;
    if constexpr (components == 3) {
      solved.x = hn::Mul(word(0), left.x);
      solved.y = mul_add(word(2), left.y, hn::Mul(word(1), left.x));
      solved.z = mul_add(word(5), left.z, mul_add(word(4), left.y, hn::Mul(word(3), left.x)));
      own += 6;
    } else {
      solved = {hn::Mul(word(0), left.x), hn::Mul(word(0), left.y), hn::Mul(word(0), left.z)};
      ++own;
    }
    store_vector(solved, at);
    square = mul_add(solved.x, solved.x, mul_add(solved.y, solved.y, mul_add(solved.z, solved.z, square)));
  }
  return square;
}

/// Solves Gᵀ·z = y in place, nodes descending, and calls `take(n, z)` for each.
template <std::uint32_t components, class Take>
HWY_INLINE void solve_backward(const BandFactor& factor, float* y, Take&& take) {
  const float* block = factor.backward.data();
  const float* own = factor.inverse_diagonal.data() + factor.inverse_diagonal.size();
  for (std::uint32_t n = factor.nodes; n-- > 0;) {
    const std::uint32_t count = factor.after[n];
    float* const at = y + node_stride * n;
    constexpr auto back = -static_cast<std::ptrdiff_t>(node_stride);
    const Vector sum = sum_couplings<components>(count, at + node_stride * count, back, block);
    const Vector r = load_vector(at);
    const Vector left{hn::Sub(r.x, sum.x), hn::Sub(r.y, sum.y), hn::Sub(r.z, sum.z)};
    Vector solved;
    if constexpr (components == 3) {
      own -= 6;
      const auto word = [own](std::size_t w) HWY_ATTR { return hn::Set(d, own[w]); };
      solved.x = mul_add(word(0), left.x, mul_add(word(1), left.y, hn::Mul(word(3), left.z)));
      solved.y = mul_add(word(2), left.y, hn::Mul(word(4), left.z));
      solved.z = hn::Mul(word(5), left.z);
    } else {
      --own;
      const V word = hn::Set(d, *own);
      solved = {hn::Mul(word, left.x), hn::Mul(word, left.y), hn::Mul(word, left.z)};
    }
    store_vector(solved, at);
    take(n, solved);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
