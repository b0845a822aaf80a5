#pragma once
// Which vertices of the skin lie over fat that wobbles.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/assets/surfaces/body_form.h>
#include <mobil/components/fat.h>

namespace mobil::inline v0_3 {

/// Of a vertex: the regions that move it, and by which part of their way, 0 to 1; 0 where none does.
struct FatPlace {
  std::array<std::uint8_t, 2> region{};
  std::array<float, 2> part{};
};

/// Of a place at rest, in the anatomical position; `arm`: how much of it is the arm's. The middle of a region moves all
/// of the way, its borders not at all; nor do kneecap, shin, elbow, hands, feet and head. The numbers are our
/// choice.
FatPlace fat_place(const form::BodyForm& form, const Vec3<double>& rest, double arm);

}  // namespace mobil::inline v0_3
