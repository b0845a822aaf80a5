// Bodies side by side in double precision. For inclusion inside Highway's targets only.

#if defined(MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#undef MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#else
#define MOBIL_ASSETS_REDUCTION_DOUBLE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "assets/reduction/modal_bellies.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {

// Multiplications and additions are never fused here, so the bits are the same with and without that instruction.
#if HWY_HAVE_FLOAT64
namespace dn = hwy::HWY_NAMESPACE;
using Tag = dn::CappedTag<double, 8>;
using V = dn::Vec<Tag>;
constexpr std::size_t width = dn::MaxLanes(Tag{});
#else
// Highway 1.0 has no vectors of doubles for WebAssembly: one body at a time.
namespace dn {
struct Tag {};
using V = double;
HWY_INLINE V Set(Tag, double x) {
  return x;
}
HWY_INLINE V Load(Tag, const double* p) {
  return *p;
}
HWY_INLINE void Store(V v, Tag, double* p) {
  *p = v;
}
HWY_INLINE V LoadU(Tag, const double* p) {
  return *p;
}
HWY_INLINE void StoreU(V v, Tag, double* p) {
  *p = v;
}
HWY_INLINE V Add(V a, V b) {
  return a + b;
}
HWY_INLINE V Sub(V a, V b) {
  return a - b;
}
HWY_INLINE V Mul(V a, V b) {
  return a * b;
}
HWY_INLINE V Div(V a, V b) {
  return a / b;
}
HWY_INLINE V Neg(V a) {
  return -a;
}
HWY_INLINE V Max(V a, V b) {
  return a > b ? a : b;
}
HWY_INLINE V Abs(V a) {
  return std::fabs(a);
}
HWY_INLINE V Sqrt(V a) {
  return std::sqrt(a);
}
HWY_INLINE V Floor(V a) {
  return std::floor(a);
}
HWY_INLINE V CopySign(V a, V sign) {
  return std::copysign(a, sign);
}
HWY_INLINE bool Gt(V a, V b) {
  return a > b;
}
HWY_INLINE bool Ge(V a, V b) {
  return a >= b;
}
HWY_INLINE bool Eq(V a, V b) {
  return a == b;
}
HWY_INLINE bool Or(bool a, bool b) {
  return a || b;
}
HWY_INLINE bool AllFalse(Tag, bool a) {
  return !a;
}
HWY_INLINE V IfThenElse(bool m, V yes, V no) {
  return m ? yes : no;
}
HWY_INLINE V IfThenElseZero(bool m, V yes) {
  return m ? yes : 0.0;
}
HWY_INLINE V IfThenZeroElse(bool m, V no) {
  return m ? 0.0 : no;
}
}  // namespace dn
using Tag = dn::Tag;
using V = dn::V;
constexpr std::size_t width = 1;
#endif
constexpr std::size_t most = max_modes;

HWY_INLINE V all(double x) {
  return dn::Set(Tag{}, x);
}
HWY_INLINE V load(const double* p) {
  return dn::Load(Tag{}, p);
}
HWY_INLINE void store(V v, double* p) {
  dn::Store(v, Tag{}, p);
}
/// Load and store at any address.
HWY_INLINE V load_any(const double* p) {
  return dn::LoadU(Tag{}, p);
}
HWY_INLINE void store_any(V v, double* p) {
  dn::StoreU(v, Tag{}, p);
}
HWY_INLINE V mul(V a, V b) {
  return dn::Mul(a, b);
}
HWY_INLINE V add(V a, V b) {
  return dn::Add(a, b);
}
HWY_INLINE V sub(V a, V b) {
  return dn::Sub(a, b);
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
