#pragma once
// Masses of people's segments by sex, age and fat.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/anthropometry.h>
#include <mobil/components/body.h>
#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Group of segments whose masses keep their ratios. A limb's group has one side. The lower trunk is the rest.
enum class MassGroup : std::uint8_t {
  head,          // with the neck
  upper_trunk,   // T9 and above, with the clavicles
  middle_trunk,  // L3 to T10
  upper_arm,
  forearm,  // with the hand
  thigh,    // with the kneecap
  shank,
  foot,         // with the toes
  lower_trunk,  // L4 and below
};
inline constexpr std::size_t mass_groups = 9;

/// Masses of the groups, parts of the body mass.
using GroupMasses = std::array<double, mass_groups>;
/// Masses of de Leva's men.
inline constexpr GroupMasses de_leva_men = {0.0694, 0.1596, 0.1633, 0.0271, 0.0223, 0.1416, 0.0433, 0.0137, 0.1117};

/// Group of each segment.
inline constexpr std::array<MassGroup, segment_count> mass_group = [] {
  using enum Segment;
  using G = MassGroup;
  std::array<G, segment_count> group{};
  const auto spread = [&](Segment first, Segment last, G of) {
    for (std::size_t s = index(first); s <= index(last); ++s) group[s] = of;
  };
  spread(pelvis, L4, G::lower_trunk);
  spread(L3, T10, G::middle_trunk);
  spread(T9, T1, G::upper_trunk);
  spread(C7, head, G::head);
  for (std::size_t side = 0; side < 2; ++side) {
    const auto put = [&](Segment right_one, G of) { group[index(on_side(right_one, side))] = of; };
    put(clavicle_right, G::upper_trunk);
    for (const Segment s : {thigh_right, patella_right}) put(s, G::thigh);
    put(shank_right, G::shank);
    for (const Segment s : {foot_right, toes_right}) put(s, G::foot);
    put(upper_arm_right, G::upper_arm);
    for (const Segment s : {forearm_right, hand_right, fingers_right, thumb_right}) put(s, G::forearm);
  }
  return group;
}();

/// Returns the masses of a request's groups with that share of fat in the mass. They add up to 1, both sides counted.
GroupMasses group_masses(const BodyRequest& request, double fat_share);
/// Return the masses of a body's groups, and of one segment.
GroupMasses group_masses(const BodySize<float>& size);
double mass_fraction(const BodySize<float>& size, std::size_t segment);

}  // namespace mobil::inline v0_3
