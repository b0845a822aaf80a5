#include <mobil/assets/body/body_measures.h>

#include <array>
#include <cmath>

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

}  // namespace

BodyMeasures body_measures(const BodyRequest& request) {
  BodyMeasures measures{};
  const double height = static_cast<double>(request.height_m) / 1.75, mass = static_cast<double>(request.mass_kg) / 75;
  for (const auto& [measure, mm, by_height, by_mass] : request.sex == Sex::woman ? women : men)
    measures.*measure = 1e-3 * mm * std::pow(height, by_height) * std::pow(mass, by_mass);
  return measures;
}

}  // namespace mobil::inline v0_3
