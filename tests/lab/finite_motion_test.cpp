// Motion at finite strain in double precision: it comes to rest in the static solution, and its error is of second
// order in the step.
#include "assets/finite/finite_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <mobil/muscle_table.h>
#include "demo/lab/frontier/frontier_active.h"

namespace mobil::finite_motion_test {
namespace {

FiniteBelly spindle() {
  const std::vector<LatticeStation> stations = {
      {0, 0, 0, 0.02F, 0.018F}, {0.4F, 0.004F, -0.005F, 0.036F, 0.03F}, {1, 0, 0, 0.014F, 0.012F}};
  return *make_finite_belly(*bend_block({2, 2, 8}, stations, 0.24), {}, 0);
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(FiniteMotion, ComesToRestInTheStaticSolution) {
  const FiniteBelly belly = spindle();
  FiniteScratch scratch = make_scratch(belly);
  FiniteMotion motion = motion_at_rest(belly);
  for (int i = 1; i <= 400; ++i) {
    const double part = std::min(1.0, i / 100.0);
    const FiniteStep next{0.005, 60, 0, 0.1 * part, 0.4 * part, {}};
    const auto done = advance(belly, scratch, next, motion);
    ASSERT_TRUE(done) << done.error().message;
  }
  FiniteState still = state_at_rest(belly);
  ASSERT_TRUE(settle(belly, scratch, still, 0.1, 0.4));
  EXPECT_LT(apart(motion.displacement_m, still.displacement_m), 2e-6);
}

/// A kick while the end moves and fibres become active, then free motion: half the step gives a quarter of the error.
TEST(FiniteMotion, IsOfSecondOrder) {
  const FiniteBelly belly = spindle();
  FiniteScratch scratch = make_scratch(belly);
  const auto after = [&](int steps) {
    FiniteMotion motion = motion_at_rest(belly);
    constexpr double time_s = 0.1;
    for (int i = 1; i <= steps; ++i) {
      const double t = time_s * i / steps, push = 20 * std::pow(std::sin(std::min(t, 0.05) / 0.05 * 3.14159265), 2);
      const double part = std::pow(std::sin(std::min(t, 0.08) / 0.08 * 1.57079633), 2);
      const FiniteStep next{time_s / steps, 8, 7, 0.05 * part, 0.3 * part, {{push, 0, 0}, {}}};
      EXPECT_TRUE(advance(belly, scratch, next, motion));
    }
    return motion.displacement_m;
  };
  const auto exact = after(800);
  const double coarse = apart(after(50), exact), fine = apart(after(100), exact);
  EXPECT_GT(coarse / fine, 3.3);
  EXPECT_LT(fine, 1e-4);
}

TEST(FiniteMotion, FailedStepChangesNothing) {
  const FiniteBelly belly = spindle();
  FiniteScratch scratch = make_scratch(belly);
  FiniteMotion motion = motion_at_rest(belly);
  const auto done = advance(belly, scratch, {0.01, 8, 7, NAN, 0.3, {}}, motion);
  ASSERT_FALSE(done);
  EXPECT_EQ(apart(motion.displacement_m, motion_at_rest(belly).displacement_m), 0);
}

/// Changes of shape and tension in shaken, active muscles are most of the error of linear bellies.
TEST(FiniteMotion, TunedBelliesMoveLikeTissue) {
  const Muscle row[] = {*find_muscle("rectus_femoris")};
  const auto found = measure_active(row, [](std::string_view, double) {});
  const auto way = [&](std::string_view name) {
    const auto& ways = found.front().ways;
    const auto at = std::ranges::find(ways, name, &ActiveError::way);
    EXPECT_NE(at, ways.end()) << name;
    return *at;
  };
  const ActiveError plain = way("modal-12"), tuned = way("modal-12, tuned, finite shape");
  EXPECT_GT(plain.jolts_all, 1.2);
  EXPECT_GT(plain.jolts_across, 0.7);
  EXPECT_LT(tuned.jolts_all, 0.25);
  EXPECT_LT(tuned.jolts_across, 0.15);
  EXPECT_LT(tuned.across, 0.4 * way("explicit-central, 81 nodes").across);
  EXPECT_LT(tuned.all, 0.4 * plain.all);
}

}  // namespace
}  // namespace mobil::finite_motion_test
