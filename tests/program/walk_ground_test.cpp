// Tests of `mobil walk --ground`.

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/program/program.h"
#include "tests/labels.h"

namespace mobil {
namespace {

/// Returns column 5 of the last row: the height of the centre of mass.
double last_height_m(const std::filesystem::path& motion) {
  std::istringstream lines(read_bytes(motion));
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty()) last = line;
  std::istringstream cells(last);
  std::string cell;
  for (int i = 0; i < 5; ++i) std::getline(cells, cell, ',');
  return std::stod(cell);
}

TEST(WalkGround, StairsAndSlopesGoUpAndDown) {
  MOBIL_SLOW();
  const TemporaryFolder folder;
  const std::string brief = "walk --muscles quadriceps --method static --seconds 3 ";
  const auto height_m = [&](const std::string& options) {
    const Ran ran = run_mobil(brief + options + " --out out", folder.path);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return last_height_m(folder.path / "out" / "motion.csv");
  };
  const double level = height_m("--speed 1.2");
  EXPECT_NEAR(height_m("--speed 1.2 --ground slope:10%"), level + 0.36, 0.08);
  EXPECT_NEAR(height_m("--speed 1.2 --ground slope:-0.1"), level - 0.36, 0.08);
  // At 1.8 steps a second; the first two steps are level.
  EXPECT_NEAR(height_m("--ground stairs:16cm/30cm"), level + 0.16 * (3 * 1.8 - 2), 0.2);
  EXPECT_NEAR(height_m("--ground stairs:-16cm/30cm"), level - 0.16 * (3 * 1.8 - 2), 0.2);
  EXPECT_NEAR(height_m("--speed 1.2 --ground kerb:15cm"), level + 0.15, 0.04);
}

TEST(WalkGround, InvalidGroundIsRefusedInOneLine) {
  const TemporaryFolder folder;
  expect_refused("walk",
                 {{"--ground moon", {"--ground", "stairs:16cm/30cm"}},
                  {"--ground slope", {"--ground", "slope:10%"}},
                  {"--ground slope:90%", {"--ground slope", "30"}},
                  {"--ground slope:1kg", {"--ground slope"}},
                  {"--ground stairs:16cm", {"--ground stairs", "rise and tread"}},
                  {"--ground stairs:16cm/3m", {"tread", "0.6"}},
                  {"--ground kerb:-1m", {"--ground kerb", "0.2"}}},
                 folder.path);
}

}  // namespace
}  // namespace mobil
