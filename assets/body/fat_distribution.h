#pragma once
// Mass of segments in people with more or less fat than the men whose segments were weighed.

#include <array>

#include <mobil/anthropometry.h>

namespace mobil::inline v0_3 {

/// Share of fat in the mass at which the published segment masses are taken to hold: a man of 24.5 kg/m²
/// (`fat_share_of_mass_index`).
inline constexpr double usual_fat_share = 0.183;

/// Distribution of fat beyond the usual share. Most is in the trunk, whose part of the body's volume grows while that
/// of arms and legs shrinks (Wang, Gallagher, Thornton, Yu, Weil, Kovac & Pi-Sunyer, Obesity 15, 2007; masses of old
/// people: Chambers, Sukits, McCrory & Cham, Clinical Biomechanics 25, 2010). The numbers are our choice; they add up
/// to 1.
constexpr std::array<double, segment_count> make_fat_parts() {
  using enum Segment;
  std::array<double, segment_count> part{};
  const auto spread = [&](Segment first, Segment last, double share) {
    double sum = 0;
    for (std::size_t s = index(first); s <= index(last); ++s) sum += unit_body.mass_fraction[s];
    for (std::size_t s = index(first); s <= index(last); ++s) part[s] = share * unit_body.mass_fraction[s] / sum;
  };
  spread(pelvis, pelvis, 0.22);
  spread(L5, L1, 0.30);
  spread(T12, T1, 0.18);
  spread(C7, head, 0.01);
  for (std::size_t side = 0; side < 2; ++side) {
    part[index(on_side(thigh_right, side))] = 0.085;
    part[index(on_side(shank_right, side))] = 0.02;
    part[index(on_side(upper_arm_right, side))] = 0.03;
    part[index(on_side(forearm_right, side))] = 0.01;
  }
  return part;
}
inline constexpr std::array<double, segment_count> fat_part = make_fat_parts();

/// Returns the part of the mass that is fat beyond the usual share; negative in the lean.
constexpr double extra_fat(double fat_share) {
  return (fat_share - usual_fat_share) / (1 - usual_fat_share);
}

/// Returns the growth of a segment's part of the mass per part of extra fat.
constexpr double mass_per_extra_fat(std::size_t segment) {
  return fat_part[segment] - unit_body.mass_fraction[segment];
}

constexpr double mass_fraction(std::size_t segment, double extra) {
  return unit_body.mass_fraction[segment] + extra * mass_per_extra_fat(segment);
}

}  // namespace mobil::inline v0_3
