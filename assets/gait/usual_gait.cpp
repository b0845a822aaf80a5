#include <mobil/usual_gait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <mobil/assets/body/between.h>

namespace mobil::inline v0_3 {
namespace {

template <std::size_t n>
using Series = std::array<double, n>;

/// Returns the value at an age of a curve that is linear between ages and constant beyond them.
template <std::size_t n>
double on_curve(double age_y, const Series<n>& ages_y, const Series<n>& value) {
  const auto [i, part] = form::between(n, age_y, [&](std::size_t k) { return ages_y[k]; });
  return std::lerp(value[i], value[i + 1], part);
}

constexpr Series<12> speed_ages_y = {6, 9, 11, 15, 18, 25, 40, 55, 65, 72, 82, 87};
constexpr Series<12> mens_m_s = {1.02, 1.02, 1.05, 1.20, 1.33, 1.33, 1.36, 1.37, 1.30, 1.17, 1.12, 1.00};
constexpr Series<12> womens_m_s = {1.02, 1.02, 1.05, 1.20, 1.33, 1.35, 1.36, 1.35, 1.29, 1.17, 1.06, 0.99};

/// Step lengths in shoes, over those of the table. `adults_step` is that of 18 to 66 years.
constexpr double adults_step = 1.035;
constexpr Series<10> step_ages_y = {6, 9, 11, 14, 18, 66, 72, 82, 87, 95};
constexpr Series<10> shod_steps = {1.15, 1.12, 1.10, 1.05, adults_step, adults_step, 0.990, 0.950, 0.925, 0.900};

double age_of(const BodyRequest& body) {
  return static_cast<double>(half_years(body.age_y));
}

}  // namespace

GaitStyle usual_style(const BodyRequest& body) {
  const double age = age_of(body), grown = std::clamp((age - 10) / 4, 0.0, 1.0),
               old = std::clamp((age - 60) / 15, 0.0, 1.6);
  const bool woman = body.sex == Sex::woman;
  const auto of_sex = [&](double child, double man, double womans) {
    return child + grown * ((woman ? womans : man) - child);
  };
  GaitStyle style;
  style.pelvis_list_deg = static_cast<float>(of_sex(4.0, 3.5, 4.25));
  style.pelvis_rotation_deg *= static_cast<float>(of_sex(1, 1, 1.10) * (1 - 0.25 * old));
  const auto arms = static_cast<float>(of_sex(1, 1, 1.05) * (1 - 0.20 * old));
  style.arm_back_deg *= arms;
  style.arm_forward_deg *= arms;
  style.trunk_lean_deg += static_cast<float>(old);
  return style;
}

float usual_speed_m_s(const BodyRequest& body) {
  return static_cast<float>(on_curve(age_of(body), speed_ages_y, body.sex == Sex::woman ? womens_m_s : mens_m_s));
}

double usual_step_factor(float age_y, Footwear footwear) {
  if (footwear == Footwear::barefoot) return 1;
  return shod_step_factor * (on_curve(static_cast<double>(age_y), step_ages_y, shod_steps) / adults_step);
}

}  // namespace mobil::inline v0_3
