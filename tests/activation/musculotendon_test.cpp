// Fibre and tendon in series, compared with double precision and measured calves, and in hard cases.
#include "systems/activation/musculotendon.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include <mobil/components/activation.h>
#include <mobil/rows.h>
#include "tests/activation/hill_reference.h"

namespace mobil::musculotendon_test {
namespace {

using test::HillMember;
constexpr float usual_tick_s = 1.0F / 60;

/// A muscle of one member in every lane.
struct Muscle1 {
  explicit Muscle1(const HillMember& of, double rest_m)
      : design(broadcast(MemberDesign<float>{static_cast<float>(of.fibre_m), static_cast<float>(of.tendon_m),
                                             static_cast<float>(of.fibre_m * std::sin(of.pennation_rad)), 0,
                                             static_cast<float>(of.force_n)})) {
    set(path, rest_m);
    find_rest_bellies(1, &path, &design);
  }
  static void set(Lanes<float>& lanes, double x) {
    for (float& lane : lanes.lane) lane = static_cast<float>(x);
  }
  MemberBlock block() { return {1, &weight, &design, &path, &excitation, &state}; }
  void rest(double path_m, double at) {
    set(path, path_m), set(excitation, at);
    settle(block(), activation, muscle);
  }
  void tick(double path_m, double at, float tick_s = usual_tick_s) {
    set(path, path_m), set(excitation, at);
    contract(block(), tick_s, activation, muscle);
  }

  float weight = 1;
  MemberDesign<Lanes<float>> design;
  Lanes<float> path{}, excitation{};
  MemberState<Lanes<float>> state{};
  Activation<Lanes<float>> activation{};
  Musculotendon<Lanes<float>> muscle{};
};

HillMember degrees(double fibre_m, double tendon_m, double pennation_deg, double force_n) {
  return {fibre_m, tendon_m, pennation_deg * std::numbers::pi / 180, force_n};
}
// Parameters of gait2392.
const HillMember medial_gastrocnemius = degrees(0.060, 0.390, 17, 1558), soleus = degrees(0.050, 0.250, 25, 3549),
                 lateral_gastrocnemius = degrees(0.064, 0.380, 8, 683),
                 vastus_lateralis = degrees(0.084, 0.157, 5, 1871);
constexpr double optimal_path(const HillMember& of) {
  return of.tendon_m + of.fibre_m * std::cos(of.pennation_rad);
}

TEST(Musculotendon, MatchesDoublePrecision) {
  std::mt19937 random(1);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  double fibre_off = 0, force_off = 0;
  for (int muscle = 0; muscle < 60; ++muscle) {
    const float tick_s =
        std::array{1.0F / 30, 1.0F / 60, 1.0F / 120, 1.0F / 240, 1.0F / 480}[static_cast<std::size_t>(muscle) % 5];
    const HillMember of = degrees(between(0.03, 0.2), between(0.08, 0.4), between(0, 28), between(300, 6000));
    const double rest = optimal_path(of) * between(0.97, 1.03);
    Muscle1 one(of, rest);
    one.rest(rest, 0.02);
    double m = test::hill_fibre(of, rest, 0.02, 1, 0), a = 0.02;
    EXPECT_NEAR(one.muscle.belly_m[0], 0, 1e-3) << "relaxed as in who stands";
    const double reach = 0.4 * of.fibre_m, pace = between(0.5, 2), asks = between(0.5, 4);
    for (int tick = 1; tick < 200; ++tick) {
      const double time = tick * double{tick_s};
      const double path = rest + reach * std::sin(2 * std::numbers::pi * pace * time);
      const double u = std::pow(std::sin(std::numbers::pi * asks * time), 2) * 0.98 + 0.01;
      const double exact_path = double{static_cast<float>(path)};
      one.tick(path, u, tick_s);
      a = test::hill_activation(a, u, double{tick_s});
      m = test::hill_fibre(of, exact_path, a, m, double{tick_s});
      EXPECT_NEAR(one.activation.activation[0], a, 1e-5);
      fibre_off = std::max(fibre_off, std::abs(double{one.state.fibre[0]} - m));
      const double force = std::max(0.0, test::hill_tendon(test::hill_tendon_m(of, exact_path, m) / of.tendon_m));
      force_off = std::max(force_off, std::abs(double{one.muscle.force_n[0]} / of.force_n - force));
    }
  }
  EXPECT_LT(fibre_off, 1e-3) << "of its optimal length";
  EXPECT_LT(force_off, 2e-3) << "of its isometric force";
}

/// Maganaris & Paul, J. Biomech. 35, 2002: gastrocnemius' tendon lengthens by 11.1 ± 3.1 mm, 4.9 ± 1 %, at maximum
/// force.
TEST(Musculotendon, CalfBellyShortensAsItsTendonLengthens) {
  for (const HillMember& of : {medial_gastrocnemius, lateral_gastrocnemius, soleus}) {
    Muscle1 one(of, optimal_path(of));
    one.rest(optimal_path(of), 0.01);
    const float tendon = one.muscle.tendon_m[0], angle = one.muscle.pennation_rad[0];
    one.rest(optimal_path(of), 1);
    const double longer = double{one.muscle.tendon_m[0] - tendon};
    EXPECT_NEAR(double{one.muscle.belly_m[0]}, -longer, 1e-6);
    EXPECT_GT(longer / of.tendon_m, 0.033);
    EXPECT_LT(longer / of.tendon_m, 0.055);
    EXPECT_GT(one.muscle.pennation_rad[0], angle + 0.02F);
  }
}

TEST(Musculotendon, StaysSoundInHardCases) {
  for (const HillMember& of : {medial_gastrocnemius, soleus, vastus_lateralis, degrees(0.2, 0.1, 0, 400)}) {
    Muscle1 one(of, optimal_path(of));
    const auto sound = [&] {
      return std::isfinite(one.muscle.force_n[0]) && one.muscle.force_n[0] >= 0 && one.state.fibre[0] >= 0.299F &&
             one.state.fibre[0] <= 1.801F && one.activation.activation[0] >= 0.01F && one.activation.activation[0] <= 1;
    };
    one.rest(optimal_path(of), 0.01);
    for (int tick = 0; tick < 36000; ++tick) {  // ten minutes of tetanus
      one.tick(optimal_path(of), 1);
      if (tick % 1000 != 0) continue;
      ASSERT_TRUE(sound());
    }
    const float held = one.muscle.force_n[0];
    one.tick(optimal_path(of), 1);
    EXPECT_EQ(one.muscle.force_n[0], held) << "a steady pull is steady to the last bit";
    for (int tick = 0; tick < 2000; ++tick) {  // flicker, and path steps beyond any joint's range
      one.tick(optimal_path(of) * (tick % 3 == 0 ? 0.6 : tick % 5 == 0 ? 1.4 : 1), tick % 2 == 0 ? 1 : 0.01);
      ASSERT_TRUE(sound()) << tick;
    }
    one.rest(0.8 * of.tendon_m, 0.5);
    EXPECT_TRUE(sound());
    EXPECT_EQ(one.muscle.slack[0], 1U);
    EXPECT_EQ(one.muscle.force_n[0], 0);
  }
}

TEST(Musculotendon, NanStaysInItsLaneAndRecovers) {
  const HillMember& of = soleus;
  Muscle1 good(of, optimal_path(of)), bad(of, optimal_path(of));
  good.rest(optimal_path(of), 0.1), bad.rest(optimal_path(of), 0.1);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int tick = 0; tick < 30; ++tick) {
    good.tick(optimal_path(of), 0.6);
    Muscle1::set(bad.path, optimal_path(of)), Muscle1::set(bad.excitation, 0.6);
    if (tick == 1) bad.path[3] = nan, bad.excitation[5] = nan, bad.state.fibre[7] = nan, bad.state.activation[9] = nan;
    contract(bad.block(), usual_tick_s, bad.activation, bad.muscle);
    for (const std::size_t lane : {0U, 1U, 2U, 4U, 6U, 8U, 15U})
      ASSERT_EQ(std::memcmp(&good.muscle.force_n[lane], &bad.muscle.force_n[lane], 4), 0);
  }
  for (const std::size_t lane : {3U, 5U, 7U, 9U}) {
    EXPECT_TRUE(std::isfinite(bad.muscle.force_n[lane])) << lane;
    EXPECT_NEAR(bad.muscle.force_n[lane], good.muscle.force_n[lane], 0.2F * good.muscle.force_n[lane] + 1) << lane;
  }
}

}  // namespace
}  // namespace mobil::musculotendon_test
