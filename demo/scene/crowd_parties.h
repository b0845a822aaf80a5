#pragma once
// Sex, age and stature of a crowd's people, and the parties in which they walk. All are drawn from a seed and a number.

#include <array>
#include <cstddef>
#include <cstdint>

#include <mobil/components/body.h>

namespace mobil {

/// A person of a block, and the party: `party_first` is the number of its first member. `drawn` is the number that
/// selects the person's own random streams. `height_z` is the standard score of stature.
struct CrowdMember {
  std::uint64_t drawn = 0, party_first = 0;
  std::uint32_t party_size = 1;
  Sex sex = Sex::man;
  float age_y = 0, height_z = 0;
};

/// Numbers of a block: 60 people alone, 27 pairs, and 13 parties of three to five.
inline constexpr std::size_t crowd_block_size = 161;
using CrowdBlock = std::array<CrowdMember, crowd_block_size>;

/// Returns the people with the numbers of a block. Sex is even; ages are drawn each by themselves, from a density that
/// is linear between its values at 6, 18, 30, 45, 60, 70, 80 and 90 years (close to the EU's in 2022, Eurostat).
/// Families are then formed from these people. A mother is near 30 ± 5 years at birth, a father 2.5 ± 4 years older.
/// Adults precede children in a party, and children under 10 years are never alone. Statures of spouses correlate by
/// 0.28, and of a child by 0.5 with either parent (Pearson & Lee, Biometrika 2, 1903). Shares of parties are assumed.
CrowdBlock crowd_block(std::uint64_t seed, std::uint64_t block);

/// Returns one person of a crowd.
CrowdMember crowd_member(std::uint64_t seed, std::uint64_t number);

}  // namespace mobil
