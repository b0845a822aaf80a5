#pragma once
// Wobbling fat under the skin: an optional effect without cost for rows that lack the component.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Regions in which fat moves as one mass on a spring.
enum class FatRegion : std::uint8_t {
  thigh_right,
  thigh_left,
  shank_right,
  shank_left,
  upper_arm_right,
  upper_arm_left,
  belly,
  seat,
};
inline constexpr std::size_t fat_regions = 8;
constexpr std::size_t index(FatRegion region) {
  return static_cast<std::size_t>(region);
}

/// Fat of each region, in the world frame. `beside_m`: offset from its position on the rigid skeleton, m. `speed_m_s`:
/// its velocity. `carried_m`: the skeleton's carrying point, m. `known`: 0 nothing, 1 `carried_m`, 2 all.
template <class F>
struct FatWobble {
  Vec3<F> beside_m[fat_regions], speed_m_s[fat_regions], carried_m[fat_regions];
  F known;
};

}  // namespace mobil::inline v0_3
