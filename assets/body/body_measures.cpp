#include <mobil/assets/body/body_measures.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <mobil/assets/body/between.h>
#include "assets/body/body_scales.h"
#include "assets/body/growth.h"

namespace mobil::inline v0_3 {
namespace {

/// A measure at 1.75 m and 75 kg, mm, and its exponents of height and mass.
struct Power {
  double BodyMeasures::*measure;
  double mm, height, mass;
};

using M = BodyMeasures;
/// 3348 men under 40.
constexpr std::array<Power, 23> men = {{
    {&M::thigh_girth, 584.3, -0.60, 0.59},         {&M::lower_thigh_girth, 387.9, -0.32, 0.45},
    {&M::calf_girth, 373.4, -0.32, 0.42},          {&M::ankle_girth, 222.3, 0.05, 0.28},
    {&M::buttock_girth, 965.5, -0.27, 0.46},       {&M::waist_girth, 854.8, -0.80, 0.72},
    {&M::chest_girth, 993.3, -0.46, 0.50},         {&M::neck_girth, 380.9, -0.35, 0.34},
    {&M::biceps_girth, 0.93 * 335.1, -0.66, 0.56}, {&M::forearm_girth, 0.95 * 296.3, -0.19, 0.37},
    {&M::wrist_girth, 171.5, 0.27, 0.19},          {&M::hip_breadth, 330.5, -0.04, 0.37},
    {&M::buttock_depth, 226.7, -0.73, 0.65},       {&M::waist_breadth, 301.5, -0.56, 0.63},
    {&M::waist_depth, 211.9, -1.06, 0.83},         {&M::chest_breadth, 279.6, 0.05, 0.26},
    {&M::chest_depth, 234.6, -0.62, 0.61},         {&M::shoulder_breadth, 488.6, -0.20, 0.36},
    {&M::head_breadth, 152.8, -0.11, 0.09},        {&M::head_length, 197.9, 0.21, 0.06},
    {&M::hand_breadth, 86.7, 0.35, 0.12},          {&M::foot_length, 268.6, 0.78, 0.06},
    {&M::foot_breadth, 100.1, 0.30, 0.14},
}};

/// 270 women of any age, from twenty places spread over the survey's list. The formulas reproduce the published means
/// of all 1986 to 0.4 % in the eight measures compared.
constexpr std::array<Power, 23> women = {{
    {&M::thigh_girth, 630.6, -0.46, 0.57},         {&M::lower_thigh_girth, 412.1, -0.27, 0.50},
    {&M::calf_girth, 381.4, -0.25, 0.43},          {&M::ankle_girth, 222.5, 0.09, 0.27},
    {&M::buttock_girth, 1051.2, -0.30, 0.48},      {&M::waist_girth, 864.9, -1.05, 0.72},
    {&M::chest_girth, 960.7, -0.64, 0.52},         {&M::neck_girth, 335.3, -0.25, 0.29},
    {&M::biceps_girth, 0.93 * 309.4, -0.62, 0.61}, {&M::forearm_girth, 0.95 * 271.2, -0.10, 0.37},
    {&M::wrist_girth, 160.4, 0.25, 0.19},          {&M::hip_breadth, 364.7, -0.17, 0.43},
    {&M::buttock_depth, 236.0, -0.73, 0.64},       {&M::waist_breadth, 302.8, -0.81, 0.65},
    {&M::waist_depth, 210.1, -1.56, 0.89},         {&M::chest_breadth, 275.1, -0.21, 0.32},
    {&M::chest_depth, 250.7, -0.84, 0.64},         {&M::shoulder_breadth, 460.3, -0.30, 0.38},
    {&M::head_breadth, 149.1, 0.01, 0.06},         {&M::head_length, 194.6, 0.22, 0.06},
    {&M::hand_breadth, 81.3, 0.41, 0.10},          {&M::foot_length, 262.9, 0.77, 0.08},
    {&M::foot_breadth, 95.8, 0.19, 0.16},
}};

/// A measure's change in ten years at equal height and mass. Those of breadths and depths that were not measured meet
/// the girths.
struct Change {
  double BodyMeasures::*measure;
  double man, woman;
};
constexpr std::array<Change, 11> changes = {{{&M::waist_girth, 0.0207, 0.0131},
                                             {&M::waist_depth, 0.0336, 0.0176},
                                             {&M::waist_breadth, 0.0116, 0.0100},
                                             {&M::buttock_girth, -0.0052, 0.0006},
                                             {&M::buttock_depth, -0.0052, 0.0006},
                                             {&M::hip_breadth, -0.0024, 0.0022},
                                             {&M::thigh_girth, -0.0147, -0.0037},
                                             {&M::calf_girth, -0.0081, -0.0110},
                                             {&M::chest_girth, 0.0097, 0.0131},
                                             {&M::chest_depth, 0.0097, 0.0131},
                                             {&M::neck_girth, 0.0064, 0.0060}}};

/// Girths of heads at 6, 8 … 16 years relative to the adult's.
constexpr std::array<double, 7> heads_of_boys = {0.929, 0.941, 0.951, 0.963, 0.976, 0.988, 1},
                                heads_of_girls = {0.938, 0.953, 0.967, 0.978, 0.987, 0.995, 1};

BodyMeasures of_powers(const BodyRequest& request) {
  BodyMeasures measures{};
  const double height = static_cast<double>(request.height_m) / 1.75, mass = static_cast<double>(request.mass_kg) / 75;
  for (const auto& [measure, mm, by_height, by_mass] : request.sex == Sex::woman ? women : men)
    measures.*measure = 1e-3 * mm * std::pow(height, by_height) * std::pow(mass, by_mass);
  return measures;
}

/// Changes an adult's measures at a child's height and mass to a child's.
void make_childs(const BodyRequest& request, BodyMeasures& m) {
  const double age = request.age_y, waist = 1 + 0.014 * std::max(0.0, 16 - age);
  for (double BodyMeasures::*measure : {&M::waist_girth, &M::waist_breadth, &M::waist_depth}) m.*measure *= waist;
  BodyRequest adult = request;
  adult.age_y = static_cast<float>(adult_age_y);
  m.shoulder_breadth *=
      static_cast<double>(make_size(request, 0).shoulders_scale_m / make_size(adult, 0).shoulders_scale_m);
  const GrowthRow& usual = growth(request.sex, adult.age_y);
  adult.height_m = static_cast<float>(usual.height_m.median);
  adult.mass_kg = static_cast<float>(usual.mass_index.median) * adult.height_m * adult.height_m;
  const BodyMeasures grown = of_powers(adult);
  const auto& heads = request.sex == Sex::woman ? heads_of_girls : heads_of_boys;
  const auto [k, t] = form::between(heads.size(), age, [](std::size_t i) { return 6 + 2.0 * static_cast<double>(i); });
  const double head = std::lerp(heads[k], heads[k + 1], t), still = std::min(1.0, (adult_age_y - age) / 2);
  for (double BodyMeasures::*measure : {&M::head_breadth, &M::head_length})
    m.*measure = std::lerp(m.*measure, head * grown.*measure, still);
}

}  // namespace

BodyMeasures body_measures(const BodyRequest& request) {
  constexpr double first_y = 18, last_y = 65;
  BodyMeasures measures = of_powers(request);
  const double decades = (std::clamp(static_cast<double>(request.age_y), first_y, last_y) - usual_age_y) / 10;
  for (const auto& [measure, man, woman] : changes)
    measures.*measure *= 1 + decades * (request.sex == Sex::woman ? woman : man);
  if (static_cast<double>(request.age_y) < adult_age_y) make_childs(request, measures);
  return measures;
}

BodyMeasures scaled(const BodyMeasures& measures, double by) {
  auto all = std::bit_cast<std::array<double, sizeof(BodyMeasures) / sizeof(double)>>(measures);
  for (double& measure : all) measure *= by;
  return std::bit_cast<BodyMeasures>(all);
}

}  // namespace mobil::inline v0_3
