#pragma once
// Fat under the skin that wobbles: an effect; who lacks this component pays nothing.

#include <cstddef>
#include <cstdint>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Where fat moves as one mass on a spring.
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

/// Of each region's fat: how far it is beside where the skeleton alone would carry it, m; how fast it moves, m/s; and
/// where the point of the skeleton was that carries it, m. World frame. `known`: 0 nothing, 1 the place, 2 all of it.
template <class F>
struct FatWobble {
  Vec3<F> beside_m[fat_regions], speed_m_s[fat_regions], carried_m[fat_regions];
  F known;
};

}  // namespace mobil::inline v0_3
