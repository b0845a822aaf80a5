// Strength of a leg: the largest isometric moments that all its lines make, fully active.
#include <gtest/gtest.h>

#include <cmath>
#include <string_view>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/assets/muscles/muscle_path.h>
#include <mobil/assets/muscles/muscle_plan.h>
#include "systems/muscles/member_design.h"
#include "tests/activation/hill_reference.h"
#include "tests/lines/turned_leg.h"

namespace mobil::leg_strength_test {
namespace {

using test::Angles, test::Freedom, test::degree;

/// A test of strength on a dynamometer: the joint moves in the sense `sign` of its angle and is measured at angles from
/// `from` to `to`, deg, with others held.
struct Effort {
  std::string_view name;
  Freedom joint;
  double sign;
  Angles held_deg;
  Freedom swept;
  double from_deg, to_deg;
};

/// Returns the largest sum of the moments of all lines that turn the joint that way, N m. Passive forces are included.
double strength_nm(const Effort& effort) {
  static const Body body = make_body({1.80F, 80}).value();
  const LegScale<double> scale = leg_scale(body);
  double best = 0;
  for (double at_deg = effort.from_deg; at_deg <= effort.to_deg; at_deg += 5) {
    Angles q{};
    for (std::size_t f = 0; f < test::freedoms; ++f) q[f] = degree * effort.held_deg[f];
    q[effort.swept] = degree * at_deg;
    double sum = 0;
    for (const MemberMuscle& line : member_muscles()) {
      const auto length = [&](const Angles& at) {
        return member_length(line, scale, test::turned_leg(at, body.thigh_length_m, body.shank_length_m));
      };
      const double arm = effort.sign * test::arm(length, q, effort.joint);
      if (arm <= 0) continue;
      const auto design =
          member_design(line, plan_member(body, line, member_length(line, scale, anatomical_leg(body))));
      const test::HillMember of{design.fibre_m, design.tendon_m, std::asin(design.height_m / design.fibre_m),
                                design.force_n};
      const double path_m = length(q), fibre = test::hill_fibre(of, path_m, 1, 1, 0);
      sum += arm * of.force_n * test::hill_tendon(test::hill_tendon_m(of, path_m, fibre) / of.tendon_m);
    }
    best = std::max(best, sum);
  }
  return best;
}

using enum Freedom;

/// Returns an effort to rotate the hip with the knee bent to 90°.
Effort rotation(double sign, double hip_deg, double reach_deg) {
  return {"rotation", hip_rotation, sign, {hip_deg, 0, 0, 90}, hip_rotation, -reach_deg, reach_deg};
}

/// An independent program has evaluated the same design of 39 lines, with other fibres in some of them. The hip's
/// flexion is measured from the level pelvis.
TEST(LegStrength, IsThatOfTheIndependentModel) {
  const std::pair<Effort, double> efforts[] = {
      {{"hip extension", hip_flexion, -1, {0, 0, 0, 60}, hip_flexion, -10, 80}, 227},
      {{"hip flexion", hip_flexion, 1, {0, 0, 0, 60}, hip_flexion, -10, 80}, 126},
      {{"hip abduction", hip_adduction, -1, {0, 0, 0, 5}, hip_adduction, -20, 20}, 131},
      {{"hip adduction", hip_adduction, 1, {0, 0, 0, 5}, hip_adduction, -20, 20}, 195},
      {rotation(1, 50, 20), 75},
      {{"knee extension", knee, -1, {70}, knee, 40, 100}, 238},
      {{"plantarflexion", ankle, -1, {0, 0, 0, 5}, ankle, -20, 20}, 212},
      {{"dorsiflexion", ankle, 1, {0, 0, 0, 60}, ankle, -30, 10}, 36},
      {{"inversion", subtalar, 1, {0, 0, 0, 60}, subtalar, -15, 15}, 49},
      {{"eversion", subtalar, -1, {0, 0, 0, 60}, subtalar, -15, 15}, 27}};
  for (const auto& [effort, wanted_nm] : efforts) EXPECT_NEAR(strength_nm(effort) / wanted_nm, 1, 0.1) << effort.name;
}

/// Knee: 95 % intervals of the mean of healthy adult men in 411 studies, N m/kg. Extension spans flexed to mid-range
/// knees, flexion is that of mid-range knees. Source: Šarabon, Kozinc & Perman, Establishing reference values for
/// isometric knee extension and flexion strength, Front. Physiol. 12, 2021. Ankle: mean ± 2 SD of the peak torque of
/// 200 people. Source: da Fonseca et al., Normative values of ankle strength, World J. Orthop. 16, 2025.
TEST(LegStrength, IsThatOfPeople) {
  constexpr double mass_kg = 80;
  const struct {
    Effort effort;
    double low_nm, high_nm;
  } measured[] = {
      {{"knee extension", knee, -1, {70}, knee, 40, 100}, 2.50 * mass_kg, 3.45 * mass_kg},
      {{"knee flexion", knee, 1, {70}, knee, 30, 60}, 1.15 * mass_kg, 1.62 * mass_kg},
      {{"plantarflexion", ankle, -1, {0, 0, 0, 5}, ankle, -20, 20}, 136.4 - 2 * 43.5, 136.4 + 2 * 43.5},
      {{"dorsiflexion", ankle, 1, {0, 0, 0, 60}, ankle, -30, 10}, 47.9 - 2 * 14.3, 47.9 + 2 * 14.3},
      {{"inversion", subtalar, 1, {0, 0, 0, 60}, subtalar, -15, 15}, 34.6 - 2 * 12.2, 34.6 + 2 * 12.2},
      {{"eversion", subtalar, -1, {0, 0, 0, 60}, subtalar, -15, 15}, 28.7 - 2 * 9.8, 28.7 + 2 * 9.8},
  };
  for (const auto& [effort, low_nm, high_nm] : measured) {
    EXPECT_GT(strength_nm(effort), low_nm) << effort.name;
    EXPECT_LT(strength_nm(effort), high_nm) << effort.name;
  }
}

/// Johnson & Hoffman, Isometric hip-rotator torque production at varying degrees of hip flexion, J. Sport Rehabil. 19,
/// 2010: inward strength is greatest at 90° and least at 10°. Lindsay et al., J. Orthop. Sports Phys. Therapy 16, 1992:
/// seated, it exceeds outward strength. People's outward strength hardly changes with flexion; the lines' falls.
TEST(LegStrength, HipRotatesInwardMoreStronglyWhenFlexed) {
  const double extended = strength_nm(rotation(1, 10, 0)), bent = strength_nm(rotation(1, 40, 0)),
               seated = strength_nm(rotation(1, 90, 0));
  EXPECT_GT(bent, 1.2 * extended);
  EXPECT_GT(seated, 1.2 * bent);
  EXPECT_GT(seated, strength_nm(rotation(-1, 90, 0)));
}

}  // namespace
}  // namespace mobil::leg_strength_test
