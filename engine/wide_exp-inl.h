// Exponential and logarithm in sixteen lanes. Include it as described in engine/wide-inl.h.

#if defined(MOBIL_ENGINE_WIDE_EXP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_WIDE_EXP_INL_H_
#undef MOBIL_ENGINE_WIDE_EXP_INL_H_
#else
#define MOBIL_ENGINE_WIDE_EXP_INL_H_
#endif

#include "engine/wide-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// Returns eˣ, relative error below 2e-7 (3e-5 without fused multiply-add), x clamped to ±87. Reduces x to ±ln 2 / 2 in
/// two parts, then evaluates Taylor's polynomial of degree 7.
MOBIL_WIDE_INLINE Wide exp(const Wide& x) {
  using IntTag = hn::RebindToSigned<FloatTag>;
  const Wide within = clamp(x, -87.0F, 87.0F);
  const Wide power = floor(fma(within, wide(1.44269504F), wide(0.5F)));
  Wide r = fnma(power, wide(0.693145752F), within);
  r = fnma(power, wide(1.42860677e-6F), r);
  Wide p = fma(r, wide(1.0F / 5040), wide(1.0F / 720));
  p = fma(p, r, wide(1.0F / 120));
  p = fma(p, r, wide(1.0F / 24));
  p = fma(p, r, wide(1.0F / 6));
  p = fma(p, r, wide(0.5F));
  p = fma(p, r, wide(1.0F));
  p = fma(p, r, wide(1.0F));
  return wide_map([&](std::size_t i) HWY_ATTR {
    const auto bits = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(IntTag{}, power.part[i]), hn::Set(IntTag{}, 127)));
    return hn::Mul(p.part[i], hn::BitCast(FloatTag{}, bits));
  });
}

/// Returns the natural logarithm of a positive normal number, absolute error below 2e-7 + 1e-7·|ln x|. Splits off the
/// power of two, and expands 2 artanh((m − 1)/(m + 1)) of the rest, √½ ≤ m < √2, up to the ninth power.
MOBIL_WIDE_INLINE Wide log(const Wide& x) {
  using IntTag = hn::RebindToSigned<FloatTag>;
  Wide power, mantissa;
  for (std::size_t i = 0; i < vector_count; ++i) {
    const auto bits = hn::BitCast(IntTag{}, x.part[i]);
    const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(IntTag{}, 0x3f3504f3)));  // √½
    power.part[i] = hn::ConvertTo(FloatTag{}, exponent);
    mantissa.part[i] = hn::BitCast(FloatTag{}, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  }
  const Wide s = (mantissa - 1.0F) / (mantissa + 1.0F), s2 = s * s;
  Wide p = fma(s2, wide(2.0F / 9), wide(2.0F / 7));
  p = fma(p, s2, wide(2.0F / 5));
  p = fma(p, s2, wide(2.0F / 3));
  p = fma(p * s2, s, 2.0F * s);
  return fma(power, wide(0.693145752F), fma(power, wide(1.42860677e-6F), p));
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
