// Rings of skin around a leg, all angles of a station at once. For inclusion inside Highway's targets only.

#if defined(MOBIL_SYSTEMS_SKINNING_RING_GRID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MOBIL_SYSTEMS_SKINNING_RING_GRID_INL_H_
#undef MOBIL_SYSTEMS_SKINNING_RING_GRID_INL_H_
#else
#define MOBIL_SYSTEMS_SKINNING_RING_GRID_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include <mobil/assets/surfaces/leg_grid.h>

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using CoverTag = hn::CappedTag<float, 16>;
using CoverIntTag = hn::RebindToSigned<CoverTag>;
using CoverV = hn::Vec<CoverTag>;
using CoverMask = hn::Mask<CoverTag>;
inline constexpr std::size_t cover_lanes = hn::MaxLanes(CoverTag{});

HWY_INLINE CoverV splat(float x) {
  return hn::Set(CoverTag{}, x);
}

/// Angles of one station, laid out so that neighbours are in different registers: angle p + l·ring_parts is lane l of
/// part p.
inline constexpr std::size_t ring_parts = leg_angles / cover_lanes;
static_assert(ring_parts == 2 || ring_parts == 4 || ring_parts == 8, "load_ring and store_ring know no other");
struct Ring {
  CoverV part[ring_parts];
};

/// Returns the places of angles in a RingGrid's station.
HWY_INLINE hn::Vec<CoverIntTag> place_in_ring(const hn::Vec<CoverIntTag>& angle) {
  const auto number = [](std::size_t n) HWY_ATTR { return hn::Set(CoverIntTag{}, static_cast<std::int32_t>(n)); };
  const auto part = hn::And(angle, number(ring_parts - 1)), lane = hn::ShiftRight<hwy::CeilLog2(ring_parts)>(angle);
  return hn::Add(hn::Mul(part, number(cover_lanes)), lane);
}

/// Returns the ring of `op(p)` for each part.
template <class Op>
HWY_INLINE Ring each_part(const Op& op) {
  Ring ring;
  for (std::size_t p = 0; p < ring_parts; ++p) ring.part[p] = op(p);
  return ring;
}

/// Convert from and to consecutive angles.
HWY_INLINE Ring load_ring(const float* angle) {
  constexpr CoverTag tag;
  Ring r;
  if constexpr (ring_parts == 2) {
    hn::LoadInterleaved2(tag, angle, r.part[0], r.part[1]);
  } else if constexpr (ring_parts == 4) {
    hn::LoadInterleaved4(tag, angle, r.part[0], r.part[1], r.part[2], r.part[3]);
  } else {
    CoverV low[4], high[4];
    hn::LoadInterleaved4(tag, angle, low[0], low[1], low[2], low[3]);
    hn::LoadInterleaved4(tag, angle + leg_angles / 2, high[0], high[1], high[2], high[3]);
    for (std::size_t p = 0; p < 4; ++p) {
      r.part[p] = hn::ConcatEven(tag, high[p], low[p]);
      r.part[p + 4] = hn::ConcatOdd(tag, high[p], low[p]);
    }
  }
  return r;
}
HWY_INLINE void store_ring(const Ring& r, float* angle) {
  constexpr CoverTag tag;
  if constexpr (ring_parts == 2) {
    hn::StoreInterleaved2(r.part[0], r.part[1], tag, angle);
  } else if constexpr (ring_parts == 4) {
    hn::StoreInterleaved4(r.part[0], r.part[1], r.part[2], r.part[3], tag, angle);
  } else {
    CoverV low[4], high[4];
    for (std::size_t p = 0; p < 4; ++p) {
      low[p] = hn::InterleaveLower(tag, r.part[p], r.part[p + 4]);
      high[p] = hn::InterleaveUpper(tag, r.part[p], r.part[p + 4]);
    }
    hn::StoreInterleaved4(low[0], low[1], low[2], low[3], tag, angle);
    hn::StoreInterleaved4(high[0], high[1], high[2], high[3], tag, angle + leg_angles / 2);
  }
}

/// Rings of all stations, each stored part by part.
struct RingGrid {
  alignas(64) float value[leg_stations][leg_angles];

  HWY_INLINE Ring at(std::size_t i) const {
    constexpr CoverTag tag;
    return each_part([&](std::size_t p) HWY_ATTR { return hn::Load(tag, value[i] + p * cover_lanes); });
  }
  HWY_INLINE void set(std::size_t i, const Ring& ring) {
    for (std::size_t p = 0; p < ring_parts; ++p) hn::Store(ring.part[p], CoverTag{}, value[i] + p * cover_lanes);
  }
};

/// Return the values at the previous and at the next angle.
HWY_INLINE Ring before(const Ring& ring) {
  constexpr CoverTag tag;
  alignas(64) std::int32_t from[cover_lanes];
  for (std::size_t l = 0; l < cover_lanes; ++l)
    from[l] = static_cast<std::int32_t>((l + cover_lanes - 1) % cover_lanes);
  const CoverV last = hn::TableLookupLanes(ring.part[ring_parts - 1], hn::SetTableIndices(tag, from));
  return each_part([&](std::size_t p) HWY_ATTR { return p == 0 ? last : ring.part[p - 1]; });
}
HWY_INLINE Ring after(const Ring& ring) {
  constexpr CoverTag tag;
  alignas(64) std::int32_t from[cover_lanes];
  for (std::size_t l = 0; l < cover_lanes; ++l) from[l] = static_cast<std::int32_t>((l + 1) % cover_lanes);
  const CoverV first = hn::TableLookupLanes(ring.part[0], hn::SetTableIndices(tag, from));
  return each_part([&](std::size_t p) HWY_ATTR { return p + 1 == ring_parts ? first : ring.part[p + 1]; });
}

/// Calls `op(i, above, here, below)` for each station in turn; the end stations replace their missing neighbours. `op`
/// can set station i of the grid, because the next stations have their input in registers.
template <class Op>
HWY_INLINE void each_station(const RingGrid& grid, const Op& op) {
  Ring here = grid.at(0), above = here;
  for (std::size_t i = 0; i < leg_stations; ++i) {
    const Ring below = i + 1 < leg_stations ? grid.at(i + 1) : here;
    op(i, above, here, below);
    above = here, here = below;
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
