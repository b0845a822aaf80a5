#pragma once
// Where fat that wobbles is shown.

#include <array>

#include <mobil/components/body.h>
#include <mobil/components/fat.h>

namespace mobil::inline v0_3 {

/// Fat is shown beside its place by this part of its thickness at most.
inline constexpr float fat_reach = 0.3F;

/// By how much each region's fat is shown beside its place, m, world frame: `beside_m`, which ever larger swings bring
/// no further than `fat_reach` of the thickness. `size`: the person's, as body_size has it.
std::array<Vec3<float>, fat_regions> shown_fat(const BodySize<float>& size, const FatWobble<float>& fat);

}  // namespace mobil::inline v0_3
