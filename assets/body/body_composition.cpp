#include <mobil/body_composition.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "assets/body/fat_distribution.h"
#include "assets/body/growth.h"
#include "engine/exact_math.h"

namespace mobil::inline v0_3 {
namespace {

constexpr double min_mass_index = 12, max_lean_index = 36;
constexpr double min_fat = 0.03, min_woman_fat = 0.08, max_fat = 0.61;
constexpr double max_mass_index = 92;
static_assert(max_mass_index < max_lean_index / (1 - max_fat));

constexpr double muscle_in_lean = 0.5, max_muscle_in_lean = 0.65, muscle_kg_per_cm3 = 1.06e-3;
/// Heath and Carter's ratings have steps of a half; two raters of the same body seldom differ by more than this.
constexpr double rating_tolerance = 1.5;

double endomorphy_of_folds(double mm) {
  return -0.7182 + mm * (0.1451 + mm * (-0.00068 + mm * 0.0000014));
}

/// Returns the folds (triceps, subscapular, supraspinale; mm, at a stature of 170.18 cm) of an endomorphy. The
/// polynomial rises throughout.
double folds_of_endomorphy(double endomorphy) {
  double low = 1, high = 400;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (endomorphy_of_folds(middle) < endomorphy ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

constexpr double fold_sum_per_three = 4.0 / 3;
struct FoldDensity {
  double at_1_mm, per_decade;
};
constexpr FoldDensity density_of(Sex sex) {
  return sex == Sex::woman ? FoldDensity{1.1599, 0.0717} : FoldDensity{1.1631, 0.0632};
}

/// Returns a value that changes evenly from `at_6` at 6 years to `at_18`.
double by_age(double age_y, double at_6, double at_18) {
  constexpr double first_age_y = 6;
  if (age_y >= adult_age_y) return at_18;
  return at_6 + (at_18 - at_6) * (age_y - first_age_y) / (adult_age_y - first_age_y);
}

double min_mass_index_at(double age_y) {
  return by_age(age_y, 10.5, min_mass_index);
}
double min_fat_of(Sex sex, double age_y) {
  return sex == Sex::woman ? min_woman_fat + child_part(age_y) * (min_fat - min_woman_fat) : min_fat;
}
/// Returns the part of skeletal muscle that is in the lower body.
double legs_in_muscle(Sex sex, double age_y) {
  return by_age(age_y, 0.46, sex == Sex::woman ? 0.55 : 0.52);
}

/// Returns the volume of Handsfield's 35 muscles of one leg.
double limb_volume_cm3(double height_m, double mass_kg) {
  return 47 * mass_kg * height_m + 1285;
}

double leg_muscle_kg(double height_m, double mass_kg) {
  return 2 * muscle_kg_per_cm3 * limb_volume_cm3(height_m, mass_kg);
}

double build_factor(const BodyRequest& request) {
  constexpr std::array<double, 4> constitution = {0.85, 1.0, 1.20, 1.08};
  const double meso = 1 + 0.06 * (static_cast<double>(request.biotype.meso) - 4);
  return constitution[static_cast<std::size_t>(request.constitution)] * meso;
}

/// Returns the volume of leg muscles over Handsfield's regression, by sex and age.
double sex_and_age_factor(const BodyRequest& request) {
  constexpr double first_loss_y = 45;
  const bool woman = request.sex == Sex::woman;
  const auto age = static_cast<double>(half_years(request.age_y));
  const double adult = (woman ? 0.91 : 1.0) * (1 - (woman ? 0.0079 : 0.0100) * std::max(0.0, age - first_loss_y));
  const double young = child_part(age);
  if (young == 0) return adult;
  constexpr double regression_in_legs = 0.961;
  const auto height = static_cast<double>(request.height_m), mass = static_cast<double>(request.mass_kg);
  const double lean = (1 - fat_share_of_mass_index(mass / (height * height), request.sex, request.age_y)) * mass;
  const double child = regression_in_legs * legs_in_muscle(request.sex, age) * by_age(age, 0.38, 0.52) * lean /
                       leg_muscle_kg(height, mass);
  return adult + young * (child - adult);
}

/// Returns x, bent smoothly from nine tenths of `most` so that it rises throughout but never reaches `most`.
double saturated(double x, double most) {
  const double knee = 0.9 * most, room = most - knee;
  return x <= knee ? x : most - room * room / (x - knee + room);
}

}  // namespace

MassRange living_mass_kg(double height_m, float age_y) {
  const double square = height_m * height_m;
  const auto age = static_cast<double>(half_years(age_y));
  const double low_kg = age < adult_age_y ? 12.0 : 30.0;
  return {std::max(low_kg, min_mass_index_at(age) * square), std::min(200.0, by_age(age, 40, max_mass_index) * square)};
}

double height_weight_ratio(double height_m, double mass_kg) {
  return 100 * height_m / exact::cbrt(mass_kg);
}

double ectomorphy(double ratio) {
  const double rated = ratio >= 40.75 ? 0.732 * ratio - 28.58 : 0.463 * ratio - 17.63;
  return std::max(0.1, rated);
}

double fat_share_of_endomorphy(double endomorphy, Sex sex) {
  const double folds_mm = fold_sum_per_three * folds_of_endomorphy(endomorphy);
  const auto [at_1_mm, per_decade] = density_of(sex);
  const double density = at_1_mm - per_decade * std::log10(folds_mm);
  return std::max(min_fat, 4.95 / density - 4.5);
}

double endomorphy_of_fat_share(double fat_share, Sex sex) {
  const double density = 4.95 / (fat_share + 4.5);
  const auto [at_1_mm, per_decade] = density_of(sex);
  const double folds_mm = exact::pow(10, (at_1_mm - density) / per_decade) / fold_sum_per_three;
  return std::clamp(endomorphy_of_folds(folds_mm), 0.1, 12.0);
}

double fat_share_of_mass_index(double body_mass_index, Sex sex, float age_y) {
  const auto age = static_cast<double>(half_years(age_y));
  const double grown = std::max(age, adult_age_y), man = sex == Sex::man ? 1 : 0, young = child_part(age);
  double percent =
      64.5 - 848 / body_mass_index + 0.079 * grown - 16.4 * man + 0.05 * man * grown + 39.0 * man / body_mass_index;
  if (young > 0) {
    const double child = 1.51 * body_mass_index - 0.70 * age - 3.6 * man + 1.4;
    percent += young * (child - percent);
  }
  return std::clamp(0.01 * percent, min_fat_of(sex, age), max_fat);
}

double physique_factor(const BodyRequest& request) {
  return build_factor(request) * sex_and_age_factor(request);
}

BodyComposition body_composition(const BodyRequest& request) {
  const auto height = static_cast<double>(request.height_m), mass = static_cast<double>(request.mass_kg);
  const double square = height * height, mass_index = mass / square;
  const Biotype usual;
  const bool asked = request.biotype.endo != usual.endo || request.biotype.ecto != usual.ecto;
  BodyComposition made;
  const auto note = [&made](BodyNote n) { made.notes = static_cast<std::uint8_t>(made.notes | static_cast<int>(n)); };

  const double ratio = height_weight_ratio(height, mass), slender = ectomorphy(ratio);
  if (asked && std::abs(static_cast<double>(request.biotype.ecto) - slender) > rating_tolerance) {
    note(BodyNote::ectomorphy);
  }

  const Sex sex = request.sex;
  const auto age = static_cast<double>(half_years(request.age_y));
  double lean = 0;
  if (asked) {
    lean = (1 - fat_share_of_endomorphy(static_cast<double>(request.biotype.endo), sex)) * mass;
  } else {
    lean = (1 - fat_share_of_mass_index(mass_index, sex, request.age_y)) * mass *
           (1 + muscle_in_lean * (build_factor(request) - 1));
  }
  const double fewest = std::max(min_mass_index_at(age) * (1 - min_fat) * square, (1 - max_fat) * mass);
  const double most = std::max(fewest, std::min(max_lean_index * square, (1 - min_fat_of(sex, age)) * mass));
  if (lean > most && most == max_lean_index * square) note(BodyNote::fat_raised);
  if (lean < fewest && asked) note(BodyNote::fat_lowered);
  lean = std::clamp(lean, fewest, most);

  const double wanted = physique_factor(request);
  const double fits = max_muscle_in_lean * lean * legs_in_muscle(sex, age) / leg_muscle_kg(height, mass);
  const double taken = saturated(wanted, fits);
  if (taken < 0.98 * wanted) note(BodyNote::muscle);

  made.body_mass_index = static_cast<float>(mass_index);
  made.height_over_cube_root_mass = static_cast<float>(ratio);
  made.lean_kg = static_cast<float>(lean);
  made.fat_kg = request.mass_kg - made.lean_kg;
  made.biotype = {static_cast<float>(endomorphy_of_fat_share(1 - lean / mass, sex)), request.biotype.meso,
                  static_cast<float>(slender)};
  made.muscle_factor = static_cast<float>(taken);
  return made;
}

double fat_share_of(const BodyComposition& composition) {
  const auto fat = static_cast<double>(composition.fat_kg), lean = static_cast<double>(composition.lean_kg);
  return fat / (fat + lean);
}

std::vector<std::string> body_notes(const Body& body) {
  const BodyRequest& asked = body.request;
  const BodyComposition& made = body.composition;
  const double fat = 100 * static_cast<double>(made.fat_kg / asked.mass_kg);
  const std::string who = fmt::format("{:.2f} m and {:.1f} kg", asked.height_m, asked.mass_kg);
  std::vector<std::string> notes;
  if (has_note(made, BodyNote::ectomorphy)) {
    notes.push_back(fmt::format("ectomorphy {:.1f} does not go with {}, which make {:.1f}; {:.1f} is taken",
                                asked.biotype.ecto, who, made.biotype.ecto, made.biotype.ecto));
  }
  if (has_note(made, BodyNote::fat_raised)) {
    notes.push_back(
        fmt::format("nobody of {:.2f} m has more than {:.0f} kg without fat; {:.0f} % of {:.1f} kg are taken as fat",
                    asked.height_m, made.lean_kg, fat, asked.mass_kg));
  }
  if (has_note(made, BodyNote::fat_lowered)) {
    notes.push_back(fmt::format("endomorphy {:.1f} would leave a body of {} too little else; fat is taken as {:.0f} %",
                                asked.biotype.endo, who, fat));
  }
  if (has_note(made, BodyNote::muscle)) {
    notes.push_back(
        fmt::format("muscles are {:.2f} times what height and mass alone give, not {:.2f}: more would not fit into "
                    "{:.1f} kg of lean mass",
                    made.muscle_factor, physique_factor(asked), made.lean_kg));
  }
  return notes;
}

}  // namespace mobil::inline v0_3
