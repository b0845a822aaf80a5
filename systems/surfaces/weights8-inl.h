// Eight-lane arithmetic of surface kernels, compiled once per instruction set (Highway), as engine/wide-inl.h.

#if defined(MOBIL_SYSTEMS_SKINNING_EIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_SKINNING_EIGHT_INL_H_
#undef MOBIL_SYSTEMS_SKINNING_EIGHT_INL_H_
#else
#define MOBIL_SYSTEMS_SKINNING_EIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include <mobil/systems/surfaces/packed_surface.h>
#include "engine/fused-inl.h"

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EightTag = hn::CappedTag<float, block_vertices>;
inline constexpr std::size_t eight_lanes = hn::MaxLanes(EightTag{}), eight_parts = block_vertices / eight_lanes;

struct WideEight {
  hn::Vec<EightTag> part[eight_parts];
};
struct EightVec {
  WideEight x, y, z;
};

HWY_INLINE WideEight load(const Eight& e) {
  WideEight r;
  for (std::size_t i = 0; i < eight_parts; ++i) r.part[i] = hn::Load(EightTag{}, e.lane + i * eight_lanes);
  return r;
}
HWY_INLINE EightVec load(const Vec3<Eight>& v) {
  return {load(v.x), load(v.y), load(v.z)};
}
HWY_INLINE WideEight add(const WideEight& a, const WideEight& b) {
  WideEight r;
  for (std::size_t i = 0; i < eight_parts; ++i) r.part[i] = hn::Add(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE WideEight multiply(const WideEight& a, const WideEight& b) {
  WideEight r;
  for (std::size_t i = 0; i < eight_parts; ++i) r.part[i] = hn::Mul(a.part[i], b.part[i]);
  return r;
}
HWY_INLINE WideEight multiply_add(const WideEight& a, const WideEight& b, const WideEight& c) {
  WideEight r;
  for (std::size_t i = 0; i < eight_parts; ++i) r.part[i] = mul_add(a.part[i], b.part[i], c.part[i]);
  return r;
}
HWY_INLINE WideEight all(float s) {
  WideEight r;
  for (std::size_t i = 0; i < eight_parts; ++i) r.part[i] = hn::Set(EightTag{}, s);
  return r;
}

/// Returns the product of the first three columns with p, plus the fourth with `shift`.
template <bool shift>
HWY_INLINE EightVec apply(const AffineMap& m, const EightVec& p) {
  EightVec r;
  WideEight* const out[3] = {&r.x, &r.y, &r.z};
  for (int i = 0; i < 3; ++i) {
    const WideEight xy = multiply_add(p.x, all(m.column[0][i]), multiply(p.y, all(m.column[1][i])));
    const WideEight mz = all(m.column[2][i]);
    const WideEight z = shift ? multiply_add(p.z, mz, all(m.column[3][i])) : multiply(p.z, mz);
    *out[i] = add(xy, z);
  }
  return r;
}

/// Four registers, each a vertex (four lanes) or two vertices i and i + 4 (eight).
struct Rows {
  hn::Vec<EightTag> row[4];
};

/// Transposes four vectors of four lanes (or twice four) to their rows, and rows to vectors.
HWY_INLINE Rows transposed(const Rows& v) {
  const EightTag tag;
  const hn::RepartitionToWide<EightTag> two;
  const auto& [first, second, third, fourth] = v.row;
  const auto low = hn::BitCast(two, hn::InterleaveLower(tag, first, second)),
             high = hn::BitCast(two, hn::InterleaveUpper(tag, first, second));
  const auto low2 = hn::BitCast(two, hn::InterleaveLower(tag, third, fourth)),
             high2 = hn::BitCast(two, hn::InterleaveUpper(tag, third, fourth));
  return {{hn::BitCast(tag, hn::InterleaveLower(two, low, low2)), hn::BitCast(tag, hn::InterleaveUpper(two, low, low2)),
           hn::BitCast(tag, hn::InterleaveLower(two, high, high2)),
           hn::BitCast(tag, hn::InterleaveUpper(two, high, high2))}};
}

/// Stores one row's vertices, each four floats at `out` + `stride` · its number.
template <class Tag>
HWY_INLINE void store_vertices(Tag, const hn::Vec<Tag>& row, float* out, std::size_t stride) {
  const hn::CappedTag<float, 4> four;
  if constexpr (hn::MaxLanes(Tag{}) == 8) {
    hn::StoreU(hn::LowerHalf(hn::Half<Tag>{}, row), four, out);
    hn::StoreU(hn::UpperHalf(hn::Half<Tag>{}, row), four, out + 4 * stride);
  } else {
    hn::StoreU(row, four, out);
  }
}

/// Loads vertices from two places as one row. Only eight lanes use the second.
template <class Tag>
HWY_INLINE hn::Vec<Tag> load_vertices(Tag tag, const float* first, [[maybe_unused]] const float* second) {
  const hn::CappedTag<float, 4> four;
  if constexpr (hn::MaxLanes(Tag{}) == 8) {
    return hn::Combine(tag, hn::Load(four, second), hn::Load(four, first));
  } else {
    return hn::Load(four, first);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
