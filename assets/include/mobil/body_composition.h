#pragma once
// What a body is made of: fat, lean mass, muscle; and which requests no real body answers.
//
// Sources, all for men of 25 years, whose segments the other tables describe.
//   Ectomorphy from height and mass, endomorphy from three skinfolds: Carter & Heath: Somatotyping, 1990; Carter: The
//     Heath-Carter Anthropometric Somatotype, Instruction Manual, 2002.
//   Density from skinfolds, 20–29 years: Durnin & Womersley, Br. J. Nutr. 32, 1974. They add a fourth fold,
//     the biceps'; we take the four as 4/3 of the three. Their fattest person had 61 % fat.
//   Fat from density: Siri, in Techniques for Measuring Body Composition, 1961.
//   Fat from body mass index, where no biotype was asked for: Gallagher et al., Am. J. Clin. Nutr. 72, 2000.
//   Fat that none lives without, 3 %: Behnke & Wilmore, Evaluation and Regulation of Body Build and Composition, 1974.
//   Most lean mass, 36 kg/m²: the leanest-heaviest wrestler of Kondo, Abe, Ikegawa, Kawakami & Fukunaga, Am. J. Hum.
//     Biol. 6, 1994, had 35.1 (121.3 kg at 1.86 m), which they hold to be near the limit.
//   Least mass, 12 kg/m²: James, Ferro-Luzzi & Waterlow 1988; Henry 1990: men die at 13, women at 11.
//   Skeletal muscle: Janssen, Heymsfield, Wang & Ross, J. Appl. Physiol. 89, 2000: 38.4 % of men's mass, half of what
//     is lean; 52 % of it in the lower body. That it can be 65 % of what is lean, at most, is our choice.
//   Leg muscles' volume: Handsfield et al. 2014, as in mobil/muscle_table.h.

#include <string>
#include <vector>

#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// A range of body masses, kg.
struct MassRange {
  double low_kg, high_kg;
};
/// What a real body of that height may weigh: a body mass index of 12 to 92 kg/m² (the most lean mass with the most
/// fat), within 30–200 kg.
MassRange living_mass_kg(double height_m);

/// Height over the cube root of mass, cm/kg^(1/3), and the ectomorphy that it makes, no less than 0.1.
double height_weight_ratio(double height_m, double mass_kg);
double ectomorphy(double height_weight_ratio);

/// Share of fat in the mass, 0–1, that an endomorphy means, by way of skinfolds (relative to stature, as Heath and
/// Carter take them) and density; and back. Both rise; the share is no less than 0.03.
double fat_share_of_endomorphy(double endomorphy);
double endomorphy_of_fat_share(double fat_share);
/// The same of a body mass index, in a man of 25 years of the average build.
double fat_share_of_mass_index(double body_mass_index);

/// What physique does to the volume of all the leg's muscles together: 0.85 thin, 1.20 athletic, 1.08 heavy, and 6 %
/// more for each point of mesomorphy above 4 (or less, below). Our choice: the published volumes do not tell
/// them apart. A body takes of it what its lean mass holds (BodyComposition::muscle_factor).
double physique_factor(const BodyRequest& request);

/// Fat, lean mass, biotype and muscle of a request within its ranges. Fat follows from the endomorphy asked for. Where
/// endomorphy and ectomorphy are the usual 3, that is where nobody asked, the lean mass is Gallagher's; half of it, the
/// muscle, is as much more or less as constitution and mesomorphy say. Then fat gives way until the lean mass is that
/// of a real body. Muscle that comes near 65 % of the lean mass grows ever less with what is asked, and never
/// beyond; it rises with height, mass and mesomorphy throughout.
BodyComposition body_composition(const BodyRequest& request);

/// How much of the mass is fat beyond the usual share (assets/body/fat_distribution.h).
double extra_fat_of(const BodyComposition& composition);

/// The notes of a body in words: one sentence each, no line breaks. Empty where the request was taken as it was.
std::vector<std::string> body_notes(const Body& body);

}  // namespace mobil::inline v0_3
