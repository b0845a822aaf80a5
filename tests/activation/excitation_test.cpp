// Excitation by phase and speed, compared with double precision and with measurements.
#include "systems/activation/excitation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <mobil/assets/files/csv_table.h>
#include "tests/labels.h"

MOBIL_TEST_LABELS("long");

namespace mobil::excitation_test {
namespace {

TEST(Excitation, LanesMatchDoublePrecision) {
  for (std::size_t m = 0; m < muscles().size(); ++m) {
    const RowExcitation row = row_excitation(static_cast<Muscle>(m));
    for (int block = 0; block < 50; ++block) {
      LegClock<Lanes<float>> clock;
      for (std::size_t l = 0; l < lane_count; ++l) {
        clock.cycle[l] = static_cast<float>((block * 16 + static_cast<int>(l)) % 97) / 97.0F;
        clock.speed[l] = static_cast<float>((block * 7 + static_cast<int>(l)) % 40) / 40.0F;
      }
      std::array<Lanes<float>, max_row_members> lanes;
      excite(row, clock, lanes.data());
      for (std::size_t i = 0; i < row.members; ++i) {
        for (std::size_t l = 0; l < lane_count; ++l) {
          const double exact = excitation(row.member[i], double{clock.cycle[l]}, double{clock.speed[l]});
          ASSERT_NEAR(lanes[i][l], exact, 2e-6) << muscle_name(static_cast<Muscle>(m));
        }
      }
    }
  }
}

TEST(Excitation, StandingPeopleHaveAStandingTone) {
  const RowExcitation row = row_excitation(*find_muscle("soleus"));
  LegClock<Lanes<float>> clock{};
  clock.cycle[3] = clock.speed[5] = std::numeric_limits<float>::quiet_NaN();  // NaN: minimum excitation; standing tone
  Lanes<float> level;
  excite(row, clock, &level);
  for (std::size_t l = 0; l < lane_count; ++l) EXPECT_EQ(level[l], l == 3 ? 0.01F : 0.05F) << l;
}

/// Excitation changes without a jump from standing to the fastest walk.
TEST(Excitation, GrowsEvenlyWithSpeed) {
  for (const MemberMuscle& muscle : member_muscles()) {
    const MemberExcitation of = member_excitation(muscle);
    for (double cycle = 0; cycle < 1; cycle += std::getenv("MOBIL_LONG") != nullptr ? 0.01 : 0.04) {
      double before = excitation(of, cycle, 0);
      for (double speed = 0.001; speed < 0.8; speed += 0.001) {
        const double now = excitation(of, cycle, speed);
        ASSERT_LT(std::abs(now - before), 0.008) << muscle.name << " at " << cycle << ", " << speed;
        before = now;
      }
    }
  }
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, ab = 0, aa = 0, bb = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / n, mb += b[i] / n;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

/// Curves correlate with measured EMG at five speeds. Peaks of single-humped curves are within 6 % of the cycle.
TEST(Excitation, MatchesMeasuredEmgAtFiveSpeeds) {
  const std::array<std::string_view, 2> required = {"task", "percent_gait"};
  const auto table = read_csv(MOBIL_SOURCE_DIR "/assets/reference/bovi2011_emg.csv", required);
  ASSERT_TRUE(table) << table.error().message;
  // Speed over √(g · leg); `mobil fit-gait --excitation` prints the sources.
  const std::map<std::string, double, std::less<>> speed = {
      {"very_slow", 0.266}, {"slow", 0.372}, {"free", 0.441}, {"medium", 0.478}, {"fast", 0.611}};
  int measured_curves = 0;
  for (const ExcitationCurve& curve : excitation_curves()) {
    if (!column(*table, curve.name)) continue;
    ++measured_curves;
    for (const auto& [task, at_speed] : speed) {
      std::vector<double> measured, ours;
      for (std::size_t r = 0; r < table->row.size(); ++r) {
        if (cell(*table, r, "task") != task) continue;
        measured.push_back(*number(cell(*table, r, curve.name)));
        ours.push_back(excitation({&curve, 0.02F}, *number(cell(*table, r, "percent_gait")) / 100, at_speed));
      }
      ASSERT_EQ(measured.size(), 51U);
      const double least = curve.name == "rectus_femoris" ? 0.8 : 0.93;
      EXPECT_GT(correlation(measured, ours), least) << curve.name << ", " << task;
    }
  }
  EXPECT_EQ(measured_curves, 6);
  for (const MemberMuscle& line : member_muscles()) {
    const std::string_view used = member_excitation(line).curve->name;
    EXPECT_EQ(column(*table, used).has_value(), is_measured(line)) << line.name;
  }
}

}  // namespace
}  // namespace mobil::excitation_test
