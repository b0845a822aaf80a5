// Fused multiply-add of a register of floats, where the target can. Highway 1.0 does not use WebAssembly's relaxed one,
// which is fused wherever the processor can fuse, nor that of 128-bit registers on x86; the library then has the bits
// that it has elsewhere. For inclusion
// inside Highway's targets only.

#if defined(MOBIL_ENGINE_FUSED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ENGINE_FUSED_INL_H_
#undef MOBIL_ENGINE_FUSED_INL_H_
#else
#define MOBIL_ENGINE_FUSED_INL_H_
#endif

#include <hwy/highway.h>
#if defined(__FMA__)
#include <immintrin.h>
#endif

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

/// a·b + c.
template <class V>
HWY_INLINE V mul_add(V a, V b, V c) {
#if HWY_TARGET == HWY_WASM && defined(__wasm_relaxed_simd__)
  return V(__builtin_wasm_relaxed_madd_f32x4(a.raw, b.raw, c.raw));
#elif HWY_TARGET == HWY_SSE4 && defined(__FMA__)
  return V{_mm_fmadd_ps(a.raw, b.raw, c.raw)};
#else
  return hwy::HWY_NAMESPACE::MulAdd(a, b, c);
#endif
}
/// c − a·b.
template <class V>
HWY_INLINE V neg_mul_add(V a, V b, V c) {
#if HWY_TARGET == HWY_WASM && defined(__wasm_relaxed_simd__)
  return V(__builtin_wasm_relaxed_nmadd_f32x4(a.raw, b.raw, c.raw));
#elif HWY_TARGET == HWY_SSE4 && defined(__FMA__)
  return V{_mm_fnmadd_ps(a.raw, b.raw, c.raw)};
#else
  return hwy::HWY_NAMESPACE::NegMulAdd(a, b, c);
#endif
}
/// a·b − c.
template <class V>
HWY_INLINE V mul_sub(V a, V b, V c) {
#if HWY_TARGET == HWY_WASM && defined(__wasm_relaxed_simd__)
  return mul_add(a, b, hwy::HWY_NAMESPACE::Neg(c));
#elif HWY_TARGET == HWY_SSE4 && defined(__FMA__)
  return V{_mm_fmsub_ps(a.raw, b.raw, c.raw)};
#else
  return hwy::HWY_NAMESPACE::MulSub(a, b, c);
#endif
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
