#pragma once
// Displayed displacement of wobbling fat.

#include <array>

#include <mobil/components/body.h>
#include <mobil/components/fat.h>

namespace mobil::inline v0_3 {

/// Maximum displayed displacement of fat, as a fraction of its thickness.
inline constexpr float fat_reach = 0.3F;

/// Returns the displayed displacement of each region's fat, m, world frame: `beside_m`, which approaches `fat_reach` of
/// the thickness for large amplitudes. `size` is the person's component.
std::array<Vec3<float>, fat_regions> shown_fat(const BodySize<float>& size, const FatWobble<float>& fat);

}  // namespace mobil::inline v0_3
