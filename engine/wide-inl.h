// Sixteen-lane arithmetic for kernels, compiled once per instruction set (Highway). Include it after
// <hwy/foreach_target.h>, and write kernels inside mobil::HWY_NAMESPACE between HWY_BEFORE_NAMESPACE() and
// HWY_AFTER_NAMESPACE(). The bits are the same on every target with fused multiply-add: no contraction, fma() always
// fused, exact division and square root, our own transcendental functions.

#if defined(MOBIL_ENGINE_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_WIDE_INL_H_
#undef MOBIL_ENGINE_WIDE_INL_H_
#else
#define MOBIL_ENGINE_WIDE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>
#include "engine/fused-inl.h"

/// For functions of ten or more operations. If sixteen lanes are four registers, these are calls: inlining such long
/// code would take longer to compile than all other targets together.
#undef MOBIL_WIDE_INLINE
#if HWY_MAX_BYTES <= 16
#define MOBIL_WIDE_INLINE HWY_NOINLINE inline
#else
#define MOBIL_WIDE_INLINE HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, lane_count>;
using WordTag = hn::RebindToUnsigned<FloatTag>;
inline constexpr std::size_t vector_lanes = hn::MaxLanes(FloatTag{});
inline constexpr std::size_t vector_count = lane_count / vector_lanes;

/// Sixteen floats in as many registers as the target needs.
struct Wide {
  hn::Vec<FloatTag> part[vector_count];
};

/// Sixteen booleans.
struct WideMask {
  hn::Mask<FloatTag> part[vector_count];
};

template <class Op>
HWY_INLINE Wide wide_map(Op op) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = op(i);
  return r;
}

HWY_INLINE Wide wide(float x) {
  Wide r;
  for (auto& p : r.part) p = hn::Set(FloatTag{}, x);
  return r;
}
HWY_INLINE Wide load(const float* p) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Load(FloatTag{}, p + i * vector_lanes);
  return r;
}
HWY_INLINE Wide load(const Lanes<float>& l) {
  return load(l.lane);
}
HWY_INLINE void store(const Wide& w, float* p) {
  for (std::size_t i = 0; i < vector_count; ++i) hn::Store(w.part[i], FloatTag{}, p + i * vector_lanes);
}
HWY_INLINE void store(const Wide& w, Lanes<float>& l) {
  store(w, l.lane);
}

#define MOBIL_WIDE_BINARY(name, call)                                                          \
  HWY_INLINE Wide name(const Wide& a, const Wide& b) {                                         \
    Wide r;                                                                                    \
    for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::call(a.part[i], b.part[i]); \
    return r;                                                                                  \
  }
MOBIL_WIDE_BINARY(operator+, Add)
MOBIL_WIDE_BINARY(operator-, Sub)
MOBIL_WIDE_BINARY(operator*, Mul)
MOBIL_WIDE_BINARY(operator/, Div)
MOBIL_WIDE_BINARY(min, Min)
MOBIL_WIDE_BINARY(max, Max)
#undef MOBIL_WIDE_BINARY

/// Operators that broadcast a number to sixteen lanes.
#define MOBIL_WIDE_WITH_NUMBER(op)                      \
  HWY_INLINE Wide operator op(const Wide& a, float b) { \
    return a op wide(b);                                \
  }                                                     \
  HWY_INLINE Wide operator op(float a, const Wide& b) { \
    return wide(a) op b;                                \
  }
MOBIL_WIDE_WITH_NUMBER(+)
MOBIL_WIDE_WITH_NUMBER(-)
MOBIL_WIDE_WITH_NUMBER(*)
MOBIL_WIDE_WITH_NUMBER(/)
#undef MOBIL_WIDE_WITH_NUMBER
HWY_INLINE Wide min(const Wide& a, float b) {
  return min(a, wide(b));
}
HWY_INLINE Wide max(const Wide& a, float b) {
  return max(a, wide(b));
}

#define MOBIL_WIDE_COMPARE(name, call)                                                         \
  HWY_INLINE WideMask name(const Wide& a, const Wide& b) {                                     \
    WideMask r;                                                                                \
    for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::call(a.part[i], b.part[i]); \
    return r;                                                                                  \
  }
MOBIL_WIDE_COMPARE(operator<, Lt)
MOBIL_WIDE_COMPARE(operator<=, Le)
MOBIL_WIDE_COMPARE(operator>, Gt)
MOBIL_WIDE_COMPARE(operator>=, Ge)
#undef MOBIL_WIDE_COMPARE
HWY_INLINE WideMask operator<(const Wide& a, float b) {
  return a < wide(b);
}
HWY_INLINE WideMask operator<=(const Wide& a, float b) {
  return a <= wide(b);
}
HWY_INLINE WideMask operator>(const Wide& a, float b) {
  return a > wide(b);
}
HWY_INLINE WideMask operator>=(const Wide& a, float b) {
  return a >= wide(b);
}

HWY_INLINE bool any(const WideMask& mask) {
  bool found = false;
  for (std::size_t i = 0; i < vector_count; ++i) found |= !hn::AllFalse(FloatTag{}, mask.part[i]);
  return found;
}

HWY_INLINE bool all(const WideMask& mask) {
  bool each = true;
  for (std::size_t i = 0; i < vector_count; ++i) each &= hn::AllTrue(FloatTag{}, mask.part[i]);
  return each;
}

HWY_INLINE Wide operator-(const Wide& a) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Neg(a.part[i]);
  return r;
}
/// Returns a·b + c, fused if the target supports it.
HWY_INLINE Wide fma(const Wide& a, const Wide& b, const Wide& c) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = mul_add(a.part[i], b.part[i], c.part[i]);
  return r;
}
/// Returns c − a·b, fused if the target supports it.
HWY_INLINE Wide fnma(const Wide& a, const Wide& b, const Wide& c) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = neg_mul_add(a.part[i], b.part[i], c.part[i]);
  return r;
}
HWY_INLINE Wide sqrt(const Wide& a) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Sqrt(a.part[i]);
  return r;
}
HWY_INLINE Wide abs(const Wide& a) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Abs(a.part[i]);
  return r;
}
HWY_INLINE Wide floor(const Wide& a) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Floor(a.part[i]);
  return r;
}
HWY_INLINE Wide clamp(const Wide& a, float low, float high) {
  return min(max(a, wide(low)), wide(high));
}
/// Returns `yes` in lanes where the mask holds, `no` in others.
HWY_INLINE Wide select(const WideMask& m, const Wide& yes, const Wide& no) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::IfThenElse(m.part[i], yes.part[i], no.part[i]);
  return r;
}
HWY_INLINE WideMask operator&(const WideMask& a, const WideMask& b) {
  WideMask r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::And(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE WideMask operator|(const WideMask& a, const WideMask& b) {
  WideMask r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::Or(a.part[i], b.part[i]);
  return r;
}
/// Returns true in lanes whose word equals `value`.
HWY_INLINE WideMask equal(const Lanes<std::uint32_t>& words, std::uint32_t value) {
  WideMask r;
  for (std::size_t i = 0; i < vector_count; ++i) {
    const auto w = hn::Load(WordTag{}, words.lane + i * vector_lanes);
    r.part[i] = hn::RebindMask(FloatTag{}, hn::Eq(w, hn::Set(WordTag{}, value)));
  }
  return r;
}
/// Returns word `word[lane]` of each lane, from a column of sixteen-lane words: base[word · 16 + lane].
HWY_INLINE Wide gather(const float* base, const Wide& word) {
  using IntTag = hn::RebindToSigned<FloatTag>;
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) {
    const auto row = hn::ShiftLeft<4>(hn::ConvertTo(IntTag{}, word.part[i]));
    const auto lane = hn::Iota(IntTag{}, static_cast<std::int32_t>(i * vector_lanes));
    r.part[i] = hn::GatherIndex(FloatTag{}, base, hn::Add(row, lane));
  }
  return r;
}

HWY_INLINE Wide copy_sign(const Wide& magnitude, const Wide& sign) {
  Wide r;
  for (std::size_t i = 0; i < vector_count; ++i) r.part[i] = hn::CopySign(magnitude.part[i], sign.part[i]);
  return r;
}

/// Computes sine and cosine of |x| < 1000 rad, error below 2e-7 (3e-5 without fused multiply-add). Reduces x to ±π/4 in
/// two parts, then evaluates least-squares polynomials (Taylor's, with an adjusted last coefficient).
MOBIL_WIDE_INLINE void sin_cos(const Wide& x, Wide& s, Wide& c) {
  const Wide quadrant = floor(fma(x, wide(0.636619772F), wide(0.5F)));
  Wide r = fnma(quadrant, wide(1.5707963705F), x);
  r = fnma(quadrant, wide(-4.37113883e-8F), r);
  const Wide r2 = r * r;
  Wide ps = fma(r2, wide(2.718311493989822e-6F), wide(-1.984090e-4F));
  ps = fma(ps, r2, wide(8.3333291e-3F));
  ps = fma(ps, r2, wide(-1.66666667e-1F));
  const Wide sine = fma(r * r2, ps, r);
  Wide pc = fma(r2, wide(2.443315711809948e-5F), wide(-1.388731625493765e-3F));
  pc = fma(pc, r2, wide(4.166664568298827e-2F));
  pc = fma(pc, r2, wide(-0.5F));
  const Wide cosine = fma(r2, pc, wide(1.0F));
  // quadrant mod 4, in floats, which are exact in this range
  const Wide q = quadrant - wide(4.0F) * floor(quadrant * wide(0.25F));
  const WideMask odd = ((q > wide(0.5F)) & (q < wide(1.5F))) | (q > wide(2.5F));
  const Wide s0 = select(odd, cosine, sine);
  const Wide c0 = select(odd, sine, cosine);
  s = select(q > wide(1.5F), -s0, s0);
  c = select((q > wide(0.5F)) & (q < wide(2.5F)), -c0, c0);
}

/// Returns the arc tangent of y/x in (−π, π], error below 4e-7 rad; 0 if both are 0.
MOBIL_WIDE_INLINE Wide atan2(const Wide& y, const Wide& x) {
  const Wide ax = abs(x);
  const Wide ay = abs(y);
  const Wide big = max(ax, ay);
  const Wide t = min(ax, ay) / max(big, wide(1e-30F));
  // two reductions: t > tan(π/8) is rotated by π/4
  const WideMask upper = t > wide(0.414213562F);
  const Wide u = select(upper, (t - wide(1.0F)) / (t + wide(1.0F)), t);
  const Wide u2 = u * u;
  Wide p = fma(u2, wide(8.05374449538e-2F), wide(-1.38776856032e-1F));
  p = fma(p, u2, wide(1.99777106478e-1F));
  p = fma(p, u2, wide(-3.33329491539e-1F));
  Wide a = fma(u * u2, p, u);
  a = select(upper, a + wide(0.785398163F), a);
  a = select(ay > ax, wide(1.57079633F) - a, a);
  a = select(x < wide(0.0F), wide(3.14159265F) - a, a);
  return copy_sign(a, y);
}

/// Returns the arc cosine of x clamped to [−1, 1].
MOBIL_WIDE_INLINE Wide acos(const Wide& x) {
  const Wide c = clamp(x, -1.0F, 1.0F);
  return atan2(sqrt(max((wide(1.0F) - c) * (wide(1.0F) + c), wide(0.0F))), c);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
