#pragma once
// Mass of segments in people with more or less fat than the men whose segments were weighed.

#include <mobil/body_composition.h>
#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Share of fat in a man of 24.5 kg/m².
inline constexpr double usual_mans_fat_share = 0.183;

/// Returns the share of fat at which the published segment masses are taken to hold. It is that of a man
/// (usual_mans_fat_share), of de Leva's women (19 years, 1.735 m, 61.9 kg), or of the median child of that age.
double usual_fat_share(Sex sex, float age_y);

/// Parts of the fat beyond the usual share, by region: pelvis, L5 to L1, T12 to T1, neck and head, and limbs of one
/// side. They add up to 1.
struct FatRegions {
  double pelvis, loins, chest, head, thigh, shank, upper_arm, forearm;
};
/// Returns where that fat is. Men's is mostly in the trunk, whose part of the body's volume grows while that of arms
/// and legs shrinks (Wang, Gallagher, Thornton, Yu, Weil, Kovac & Pi-Sunyer, Obesity 15, 2007; masses of old people:
/// Chambers, Sukits, McCrory & Cham, Clinical Biomechanics 25, 2010). Women have less in the trunk and more in the
/// legs. The numbers are our choice; women's lean toward the fat indices of women over men in Hinton et al. 2017 (legs
/// +83 %, trunk +47 %, arms +39 %).
const FatRegions& fat_regions_of(Sex sex);

}  // namespace mobil::inline v0_3
