// Fused multiply-add of a register of floats. Highway 1.0 uses neither WebAssembly's relaxed one, which is fused if the
// processor can, nor that of 128-bit registers on x86. With these the library's bits are the same on all such targets.
// Include this only inside Highway's targets.

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

/// Returns a·b + c.
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
/// Returns c − a·b.
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
/// Returns a·b − c.
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
