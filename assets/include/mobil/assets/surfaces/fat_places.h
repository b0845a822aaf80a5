#pragma once
// Vertices of the skin over fat that wobbles.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/fat.h>

namespace mobil::inline v0_3 {

/// Regions that move a vertex, and its share of their motion, 0 to 1; 0 if none does.
struct FatPlace {
  std::array<std::uint8_t, 2> region{};
  std::array<float, 2> part{};
};

/// Returns the regions of a point at rest in the anatomical position; `arm` is the arm's share of it. The middle of a
/// region moves fully, its borders do not. Nor do kneecap, shin, elbow, hands, feet and head. The numbers are our
/// choice.
FatPlace fat_place(const form::BodyForm& form, const Vec3<double>& rest, double arm);

}  // namespace mobil::inline v0_3
