// Bodies side by side in double precision. For inclusion inside Highway's targets only.

#if defined(MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#undef MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#else
#define MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "assets/reduction/reduced_bellies.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Multiplications and additions are never fused here: the same bits with and without that instruction.
using Tag = hn::CappedTag<double, 8>;
using V = hn::Vec<Tag>;
constexpr std::size_t width = hn::MaxLanes(Tag{});
constexpr std::size_t most = most_vectors;

HWY_INLINE V all(double x) {
  return hn::Set(Tag{}, x);
}
HWY_INLINE V load(const double* p) {
  return hn::Load(Tag{}, p);
}
HWY_INLINE void store(V v, double* p) {
  hn::Store(v, Tag{}, p);
}
HWY_INLINE V mul(V a, V b) {
  return hn::Mul(a, b);
}
HWY_INLINE V add(V a, V b) {
  return hn::Add(a, b);
}
HWY_INLINE V sub(V a, V b) {
  return hn::Sub(a, b);
}

}  // namespace mobil::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
