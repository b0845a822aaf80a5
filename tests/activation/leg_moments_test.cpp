// Legs with active muscles in a walk: moments of their forces at the joints, and the share of the tendons. The tests
// share one stride, so they run in one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <mobil/components/activation.h>
#include <mobil/components/pose.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include "tests/activation/pulling_walker.h"

namespace mobil::leg_moments_test {
namespace {

/// One tick of the right leg.
struct Instant {
  float cycle = 0, knee_extension_nm = 0, plantarflexion_nm = 0, walk_knee_nm = 0, walk_ankle_nm = 0;
  struct Of {
    float line_m, fibre_m, tendon_m, activation;
  };
  std::map<std::string_view, Of> muscle{};
};

/// Returns a stride at people's usual speed, with all single muscles.
const std::vector<Instant>& stride() {
  static const std::vector<Instant> all = [] {
    std::vector<Instant> instants;
    Simulation simulation;
    const auto walker = test::pulling_walker(simulation, 1.39F);
    if (!walker) return instants;
    const Entity person = *walker;
    for (int tick = 0; tick < 300; ++tick) {
      simulation.tick();
      const Feet<float> feet = *simulation.get<Feet>(person);
      if (tick < 180 || (!instants.empty() && feet.phase[Side::right] < instants.back().cycle)) {
        if (tick > 260) break;
        instants.clear();
        if (tick < 180) continue;
      }
      Instant now{feet.phase[Side::right]};
      const JointMoments<float> moments = *simulation.get<JointMoments>(person);
      now.walk_knee_nm = moments.knee_nm[Side::right];
      now.walk_ankle_nm = moments.ankle_nm[Side::right];
      for (const MuscleRef& own : simulation.muscles(person)) {
        const Entity muscle = own.entity[Side::right];
        const auto pull = *simulation.get<Musculotendon>(muscle);
        const auto arms = *simulation.get<LineMotion>(muscle);
        now.knee_extension_nm -= pull.force_n * arms.knee_flexion_arm_m;
        now.plantarflexion_nm -= pull.force_n * arms.ankle_dorsiflexion_arm_m;
        now.muscle[muscle_name(own.muscle)] = {simulation.get<LineOfAction>(muscle)->length_m, pull.fibre_m,
                                               pull.tendon_m, simulation.get<Activation>(muscle)->activation};
      }
      instants.push_back(now);
    }
    return instants;
  }();
  return all;
}

const Instant& at(float cycle) {
  return *std::ranges::min_element(stride(), {}, [&](const Instant& i) { return std::abs(i.cycle - cycle); });
}

/// The scale of excitations (assets/muscles/excitation_curves.h) is chosen to meet these bounds.
TEST(LegMoments, HaveTheMeasuredSize) {
  ASSERT_GT(stride().size(), 40U);
  float ankle = 0, walk_ankle = 0, knee = 0, walk_knee = 0;
  for (const Instant& now : stride()) {
    ankle = std::max(ankle, now.plantarflexion_nm), walk_ankle = std::max(walk_ankle, now.walk_ankle_nm);
    if (now.cycle > 0.3F) continue;
    knee = std::max(knee, now.knee_extension_nm), walk_knee = std::max(walk_knee, now.walk_knee_nm);
  }
  EXPECT_GT(ankle, 0.8F * walk_ankle);
  EXPECT_LT(ankle, 1.2F * walk_ankle);
  EXPECT_GT(knee, 0.7F * walk_knee);
  EXPECT_LT(knee, 1.3F * walk_knee);
}

/// Lichtwark & Wilson 2006, Fukunaga et al. 2001: in stance the calf's fibres are nearly isometric and its tendon
/// lengthens.
TEST(LegMoments, TendonOfTheCalfTakesMostOfItsLengthening) {
  const auto& from = at(0.10F).muscle.at("gastrocnemius_medial");
  const auto& to = at(0.42F).muscle.at("gastrocnemius_medial");
  const float longer = to.line_m - from.line_m;
  EXPECT_GT(longer, 0.010F);
  EXPECT_GT(to.tendon_m - from.tendon_m, 0.6F * longer);
  float least = 1, most = 0;
  for (const Instant& now : stride()) {
    if (now.cycle < 0.10F || now.cycle > 0.42F) continue;
    least = std::min(least, now.muscle.at("gastrocnemius_medial").fibre_m);
    most = std::max(most, now.muscle.at("gastrocnemius_medial").fibre_m);
  }
  EXPECT_LT(most - least, 0.12F * 0.062F);
}

}  // namespace
}  // namespace mobil::leg_moments_test
