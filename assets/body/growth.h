#pragma once
// Sizes by age and sex: growth charts of children and means of adults.

#include <mobil/components/body.h>

namespace mobil::inline v0_3 {

/// Age at which bodies are adults, years.
inline constexpr double adult_age_y = 18;

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

}  // namespace mobil::inline v0_3
