#pragma once
// Mass of segments in people with more or less fat than the men whose segments were weighed.

#include <array>

#include <mobil/anthropometry.h>

namespace mobil::inline v0_3 {

/// Share of fat in the mass at which the published segment masses are taken to hold: a man of 24.5 kg/m²
/// (`fat_share_of_mass_index`), and de Leva's women of 19 years, 1.735 m and 61.9 kg.
inline constexpr double usual_fat_share = 0.183, usual_woman_fat_share = 0.248;

/// Parts of the fat beyond the usual share, by region; limbs of one side. They add up to 1.
struct FatRegions {
  double pelvis, loins, chest, head, thigh, shank, upper_arm, forearm;
};
constexpr std::array<double, segment_count> make_fat_parts(const FatRegions& of) {
  using enum Segment;
  std::array<double, segment_count> part{};
  const auto spread = [&](Segment first, Segment last, double share) {
    double sum = 0;
    for (std::size_t s = index(first); s <= index(last); ++s) sum += unit_body.mass_fraction[s];
    for (std::size_t s = index(first); s <= index(last); ++s) part[s] = share * unit_body.mass_fraction[s] / sum;
  };
  spread(pelvis, pelvis, of.pelvis);
  spread(L5, L1, of.loins);
  spread(T12, T1, of.chest);
  spread(C7, head, of.head);
  for (std::size_t side = 0; side < 2; ++side) {
    part[index(on_side(thigh_right, side))] = of.thigh;
    part[index(on_side(shank_right, side))] = of.shank;
    part[index(on_side(upper_arm_right, side))] = of.upper_arm;
    part[index(on_side(forearm_right, side))] = of.forearm;
  }
  return part;
}
/// Men's distribution. Most is in the trunk, whose part of the body's volume grows while that of arms and legs shrinks
/// (Wang, Gallagher, Thornton, Yu, Weil, Kovac & Pi-Sunyer, Obesity 15, 2007; masses of old people: Chambers, Sukits,
/// McCrory & Cham, Clinical Biomechanics 25, 2010). The numbers are our choice.
inline constexpr std::array<double, segment_count> man_fat_part =
    make_fat_parts({0.22, 0.30, 0.18, 0.01, 0.085, 0.02, 0.03, 0.01});
/// Women's distribution: less in the trunk, more in the legs. The numbers are our choice, toward the fat indices of
/// women over men in Hinton et al. 2017 (legs +83 %, trunk +47 %, arms +39 %).
inline constexpr std::array<double, segment_count> woman_fat_part =
    make_fat_parts({0.19, 0.27, 0.16, 0.006, 0.115, 0.025, 0.035, 0.012});
/// Distribution that `make_body` and all kernels use for both sexes, because kernels have no lane for the sex. When
/// they have one, this is the place to mix both.
inline constexpr const std::array<double, segment_count>& fat_part = man_fat_part;

/// Returns the part of the mass that is fat beyond the usual share of that sex; negative in the lean.
constexpr double extra_fat(double fat_share, Sex sex) {
  const double usual = sex == Sex::woman ? usual_woman_fat_share : usual_fat_share;
  return (fat_share - usual) / (1 - usual);
}

/// Returns the growth of a segment's part of the mass per part of extra fat.
constexpr double mass_per_extra_fat(std::size_t segment) {
  return fat_part[segment] - unit_body.mass_fraction[segment];
}

constexpr double mass_fraction(std::size_t segment, double extra) {
  return unit_body.mass_fraction[segment] + extra * mass_per_extra_fat(segment);
}

}  // namespace mobil::inline v0_3
