#pragma once
// Sizes by age and sex: growth charts of children and means of adults.

#include <algorithm>

#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Ages at which charts and formulas of children end, and at which bodies are adults, years.
inline constexpr double last_child_age_y = 14, adult_age_y = 18;

/// Returns the weight of children's formulas in a mix with adults' ones: 1 up to 14 years, 0 from 18 on.
constexpr double child_part(double age_y) {
  return std::clamp((adult_age_y - age_y) / (adult_age_y - last_child_age_y), 0.0, 1.0);
}

/// Distribution of a measure: Box–Cox power, median, coefficient of variation (Cole's LMS method).
struct Lms {
  double power, median, spread;
};
/// Returns the value at a number of standard deviations. It rises with `deviations`.
double lms_value(const Lms& of, double deviations);

/// Distributions of stature, m, and of body mass index, kg/m².
struct GrowthRow {
  Lms height_m, mass_index;
};
/// Returns the row of that age (6 to 20 years, kept to half years) of the CDC growth charts for the United States
/// (Kuczmarski et al., Vital and Health Statistics 11(246), 2002; public domain).
const GrowthRow& growth(Sex sex, float age_y);

/// Returns the stature lost since 30 years, m (Sorkin, Muller & Andres, Am. J. Epidemiol. 150, 1999).
double lost_height_m(Sex sex, float age_y);

}  // namespace mobil::inline v0_3
