// Lengths of people of both sexes and all ages.
//
// Adults: powers of height and mass, fitted to the measured subjects of ANSUR II (Gordon et al., 2012 Anthropometric
// Survey of U.S. Army Personnel, NATICK/TR-15/007; public). Children: an adult's proportions at 18 years times factors
// by age; legs from the Berkeley Guidance Study (Tuddenham & Snyder, Univ. Calif. Publ. Child Dev. 1, 1954) and the
// subjects of Pinzone, Schwartz, Thomason & Baker (Gait & Posture 40, 2014), shoulders from the former. Our assumption:
// the head's height and the arms by age. Old people lose height in the trunk alone; their limbs are
// those of their height at 30 years.

#include "assets/body/body_scales.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/body/between.h>
#include "assets/body/growth.h"
#include "assets/body/segment_masses.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

/// A length at the reference height and mass, m, and its powers of both.
struct PowerLaw {
  double at_reference_m, of_height, of_mass;
};

/// AdultLengths of one sex: means of height and mass, lengths.
struct AdultLengths {
  double height_m, mass_kg;
  PowerLaw shoulders, upper_arm, forearm, neck_and_head;  // shoulders: both joints apart
};
/// Distance of the shoulder joints over the biacromial breadth.
constexpr double joints_of_breadth = 0.845;
constexpr AdultLengths lengths_of_men = {1.7562,
                                         85.52,
                                         {joints_of_breadth * 0.4166, 0.391, 0.121},
                                         {0.3354, 1.025, 0.019},
                                         {0.2680, 1.041, -0.002},
                                         {0.2385, 0.854, -0.089}};
constexpr AdultLengths lengths_of_women = {1.6285,
                                           67.76,
                                           {joints_of_breadth * 0.3656, 0.563, 0.082},
                                           {0.3112, 1.035, 0.039},
                                           {0.2415, 1.076, 0.038},
                                           {0.2329, 0.557, -0.018}};

constexpr double first_factor_y = 6, apart_y = 2;
using ByAge = std::array<double, 7>;  // at 6, 8 … 18 years
struct ChildFactors {
  ByAge leg, shoulders;
};
constexpr ChildFactors factors_of_boys = {{0.940, 0.968, 0.988, 1.012, 1.013, 1.005, 1},
                                          {0.962, 0.953, 0.946, 0.946, 0.954, 0.981, 1}};
constexpr ChildFactors factors_of_girls = {{0.948, 0.978, 0.997, 1.016, 1.006, 1.001, 1},
                                           {0.985, 0.984, 0.989, 0.984, 0.981, 0.994, 1}};
constexpr ByAge arms = {0.965, 0.9725, 0.98, 0.99, 1, 1, 1}, heads = {0.90, 0.92, 0.94, 0.96, 0.9733, 0.9867, 1};

double at_age(const ByAge& factors, double age_y) {
  const auto [i, part] = form::between(factors.size(), age_y,
                                       [](std::size_t k) { return first_factor_y + apart_y * static_cast<double>(k); });
  return std::lerp(factors[i], factors[i + 1], part);
}

/// Returns the length in an adult.
double length_m(const PowerLaw& law, const AdultLengths& of, double height_m, double mass_kg) {
  return law.at_reference_m * exact::pow(height_m / of.height_m, law.of_height) *
         exact::pow(mass_kg / of.mass_kg, law.of_mass);
}

/// Height of the hips over the stature in adults of the reference height, over that of the unit body: 0.516 (ANSUR II
/// 0.513 in men, 0.519 in women; de Leva 0.514). Taller adults have longer legs for their height.
constexpr double adult_leg = 0.516 / fraction::hip_height, leg_power = 0.16;
double leg_scale_m(const AdultLengths& of, double height_m) {
  return adult_leg * height_m * exact::pow(height_m / of.height_m, leg_power);
}

/// Lengths of a person, m.
struct Lengths {
  double leg_scale, shoulders, upper_arm, forearm, neck_and_head;
};

Lengths adult_lengths(const AdultLengths& of, const BodyRequest& request) {
  const double mass = request.mass_kg;
  const double height = static_cast<double>(request.height_m) + lost_height_m(request.sex, request.age_y);
  const auto length = [&](const PowerLaw& law) { return length_m(law, of, height, mass); };
  return {leg_scale_m(of, height), length(of.shoulders), length(of.upper_arm), length(of.forearm),
          length(of.neck_and_head)};
}

/// A child's lengths vary about those of the median child of that age as an adult's do about the reference.
Lengths child_lengths(const AdultLengths& of, const ChildFactors& factors, const BodyRequest& request) {
  const double age = request.age_y, height = request.height_m;
  const auto median = [&](float age_y) {
    const GrowthRow& row = growth(request.sex, age_y);
    const double tall = row.height_m.median;
    return std::pair(tall, row.mass_index.median * tall * tall);
  };
  const auto [now_m, now_kg] = median(request.age_y);
  const auto [then_m, then_kg] = median(adult_age_y);
  const auto length = [&](const PowerLaw& law, double factor) {
    return factor * length_m(law, of, then_m / now_m * height, then_kg / now_kg * static_cast<double>(request.mass_kg));
  };
  const double size = now_m / then_m, arm = size * at_age(arms, age);
  return {adult_leg * at_age(factors.leg, age) * height, length(of.shoulders, size * at_age(factors.shoulders, age)),
          length(of.upper_arm, arm), length(of.forearm, arm), length(of.neck_and_head, at_age(heads, age))};
}

}  // namespace

BodySize<float> make_size(const BodyRequest& request, float fat_share) {
  const bool is_man = request.sex == Sex::man;
  const AdultLengths& of = is_man ? lengths_of_men : lengths_of_women;
  const auto age = static_cast<double>(half_years(request.age_y));
  const Lengths is = age < adult_age_y ? child_lengths(of, is_man ? factors_of_boys : factors_of_girls, request)
                                       : adult_lengths(of, request);
  const GroupMasses masses = group_masses(request, static_cast<double>(fat_share));
  const auto mass = [&](MassGroup group) { return static_cast<float>(masses[static_cast<std::size_t>(group)]); };
  // Neck and head, which begin in the middle of C7, leave the rest to the trunk.
  constexpr double c7 = column_height(Segment::C7), neck = 0.5 * (c7 + column_height(Segment::C6));
  const double head = is.neck_and_head / (1 - neck), hips = fraction::hip_height * is.leg_scale;
  BodySize<float> size{};
  size.height_m = request.height_m;
  size.mass_kg = request.mass_kg;
  size.fat_share = fat_share;
  size.leg_scale_m = static_cast<float>(is.leg_scale);
  size.trunk_scale_m = static_cast<float>((static_cast<double>(request.height_m) - hips - (1 - c7) * head) /
                                          (c7 - fraction::hip_height));
  size.shoulders_scale_m = static_cast<float>(is.shoulders / (2 * fraction::shoulder_half_spacing));
  size.arm_scale_m = static_cast<float>((is.upper_arm + is.forearm) / (fraction::upper_arm + fraction::forearm));
  size.head_mass = mass(MassGroup::head);
  size.upper_trunk_mass = mass(MassGroup::upper_trunk);
  size.middle_trunk_mass = mass(MassGroup::middle_trunk);
  size.upper_arm_mass = mass(MassGroup::upper_arm);
  size.forearm_mass = mass(MassGroup::forearm);
  size.thigh_mass = mass(MassGroup::thigh);
  size.shank_mass = mass(MassGroup::shank);
  size.foot_mass = mass(MassGroup::foot);
  size.woman = is_man ? 0.0F : 1.0F;
  size.child = static_cast<float>(std::clamp((16 - age) / 9, 0.0, 1.0));
  // Curvature of the thoracic column grows by 20° from 50 to 100 years in women; half of that in men is assumed.
  constexpr double per_year_rad = 0.4 * std::numbers::pi / 180;
  size.stoop_rad = static_cast<float>((is_man ? 0.5 : 1.0) * per_year_rad * std::max(age - 50, 0.0));
  return size;
}

}  // namespace mobil::inline v0_3
