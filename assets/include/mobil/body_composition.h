#pragma once
// Body composition: fat, lean mass and muscle of a body, and the limits of a real body.
//
// Sources, for adults of both sexes unless noted.
//   Ectomorphy from height and mass, endomorphy from three skinfolds: Carter & Heath, Somatotyping, 1990; Carter, The
//     Heath-Carter Anthropometric Somatotype, Instruction Manual, 2002.
//   Density from skinfolds, men and women of 20–29 years: Durnin & Womersley, Br. J. Nutr. 32, 1974. They add a fourth
//     fold, the biceps'; the four are taken as 4/3 of the three. Their fattest person had 61 % fat.
//   Fat from density: Siri, in Techniques for Measuring Body Composition, 1961.
//   Fat from body mass index, if no biotype is requested: Gallagher et al., Am. J. Clin. Nutr. 72, 2000, with sex and
//     age; up to 14 years Deurenberg, Weststrate & Seidell, Br. J. Nutr. 65, 1991; a straight mix from 14 to 18.
//   Essential fat, 3 % (men, children) and 8 % (women): Behnke & Wilmore, Evaluation and Regulation of Body Build and
//     Composition, 1974, with a lower value for women.
//   Maximum lean mass, 36 kg/m²: Kondo, Abe, Ikegawa, Kawakami & Fukunaga, Am. J. Hum. Biol. 6, 1994. Their wrestler
//     with the largest lean mass had 35.1 (121.3 kg at 1.86 m), which they consider near the limit.
//   Minimum mass, 12 kg/m²: James, Ferro-Luzzi & Waterlow 1988; Henry 1990 (men die at 13, women at 11). Children: 10.5
//     at 6 years, our choice.
//   Skeletal muscle: Janssen, Heymsfield, Wang & Ross, J. Appl. Physiol. 89, 2000. It is 38.4 % of men's mass, half of
//     the lean mass, with 52 % of it in the lower body (women 55 %). The limit of 65 % of the lean mass is our choice.
//   Volume of leg muscles: Handsfield et al. 2014, as in mobil/muscle_table.h. Women's are 0.91 of it, and from 45
//   years
//     on men lose 1.00 % and women 0.79 % of it a year: Maden-Wilkinson et al., J. Musculoskelet. Neuronal Interact.
//     14, 2014; the age at which the loss begins is Janssen's.
//   Leg muscle of children: assumed, because no published table was found. Muscle is 38 % of the usual lean mass at 6
//     years and 52 % at 18; 46 % of it is in the lower body at 6 years, and the adult's share at 18. Handsfield's
//     muscles are 0.961 of the lower body's. From 14 to 18 years the result is mixed with the adult's.

#include <string>
#include <vector>

#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// A range of body masses, kg.
struct MassRange {
  double low_kg, high_kg;
};
/// Returns the range of masses of a real body of that height and age. Adults have a body mass index of 12 to 92 kg/m²
/// (maximum lean mass with maximum fat), within 30–200 kg. Below 18 years the index is 10.5 to 40 at 6 years and rises
/// evenly to the adult's, and the mass is at least 12 kg.
MassRange living_mass_kg(double height_m, float age_y = usual_age_y);
/// A range of statures, m.
struct StatureRange {
  double low_m, high_m;
};
/// Returns the range of statures of that sex and age: 1.2–2.2 m for adults, and 4.5 standard deviations of the CDC
/// growth charts, in whole centimetres, below 18 years.
StatureRange living_height_m(Sex sex, float age_y);

/// Returns height over the cube root of mass, cm/kg^(1/3). `ectomorphy` rates it, with a minimum of 0.1.
double height_weight_ratio(double height_m, double mass_kg);
double ectomorphy(double height_weight_ratio);

/// Convert an endomorphy to the share of fat in the mass, 0–1, and back, through skinfolds (relative to stature, as in
/// Heath and Carter) and density. Both functions rise; the share is at least 0.03.
double fat_share_of_endomorphy(double endomorphy, Sex sex = Sex::man);
double endomorphy_of_fat_share(double fat_share, Sex sex = Sex::man);
/// Returns the share of fat at a body mass index (kg/m²) in a person of average build. It is at least 0.03, in women
/// 0.08, and at most 0.61.
double fat_share_of_mass_index(double body_mass_index, Sex sex = Sex::man, float age_y = usual_age_y);

/// Returns the factor of build, sex and age on the volume of all leg muscles. The factor of build is 0.85 thin, 1.20
/// athletic, 1.08 heavy, and 6 % more for each point of mesomorphy above 4 (less below). This is our choice, because
/// the published volumes do not distinguish builds. The sources above have sex and age. A body uses as much of the
/// factor as its lean mass can hold (BodyComposition::muscle_factor).
double physique_factor(const BodyRequest& request);

/// Returns fat, lean mass, biotype and muscle of a request within its ranges. Fat follows from the requested
/// endomorphy. If endomorphy and ectomorphy have their default of 3, fat follows from the body mass index. Half of the
/// lean mass, the muscle, is then scaled by constitution and mesomorphy. Fat is adjusted until the lean mass is that of
/// a real body: 11.6 to 36 kg/m², in children of 6 years at least 10.2. Muscle saturates below 65 % of the lean mass;
/// it rises with height, mass and mesomorphy throughout.
BodyComposition body_composition(const BodyRequest& request);

/// Returns the share of fat in the mass, 0–1.
double fat_share_of(const BodyComposition& composition);

/// Returns the notes of a body in words, one sentence each without line breaks. Empty if the request was met unchanged.
std::vector<std::string> body_notes(const Body& body);

}  // namespace mobil::inline v0_3
