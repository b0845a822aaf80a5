// `mobil paper`: its output and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "demo/lab/paper/paper_cycle.h"
#include "demo/lab/paper/paper_table.h"
#include "demo/program/must.h"
#include "tests/program/program.h"

namespace mobil::paper_test {
namespace fs = std::filesystem;

/// Returns true if every opened element is closed, in order, and nothing remains.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos) return false;
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  return open.empty() && xml.starts_with("<svg ");
}

void expect_plot(const fs::path& file) {
  const std::string svg = read_bytes(file);
  EXPECT_TRUE(well_formed(svg)) << file;
  EXPECT_EQ(svg.find("nan"), std::string::npos) << file;
  EXPECT_EQ(svg.find("inf"), std::string::npos) << file;
}

/// Runs without a graphics device; skips if the driver cannot be hidden.
Ran run_blind(const std::string& arguments, const fs::path& in) {
  return run_shell("__EGL_VENDOR_LIBRARY_DIRS=/nowhere '" MOBIL_PROGRAM "' paper " + arguments, in);
}

void expect_same_speed_and_more_force_for_more_mass(const fs::path& made) {
  const Csv table(made / "weight.csv");
  ASSERT_EQ(table.rows.size(), 3U);
  for (std::size_t r = 0; r < 3; ++r) {
    EXPECT_NEAR(table.number(r, "step_length_m") * table.number(r, "step_frequency_hz"), 5 / 3.6, 1e-4);
    EXPECT_GT(table.number(r, "peak_vertical_weights"), 1);
    if (r == 0) continue;
    EXPECT_GT(table.number(r, "peak_vertical_n"), table.number(r - 1, "peak_vertical_n"));
  }
}

void expect_longer_steps_to_lower_the_centre_of_mass(const fs::path& made, const std::string& told) {
  const Csv table(made / "step-length.csv");
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_NEAR(table.number(0, "step_length_m") / table.number(1, "step_length_m"), 0.8, 1e-4);
  EXPECT_NEAR(table.number(2, "step_length_m") / table.number(1, "step_length_m"), 1.2, 1e-4);
  for (std::size_t r = 1; r < 3; ++r) {
    EXPECT_LT(table.number(r, "com_mean_height_mm"), table.number(r - 1, "com_mean_height_mm"));
    EXPECT_GT(table.number(r, "com_excursion_mm"), table.number(r - 1, "com_excursion_mm"));
  }
  // The sentence contains the table's numbers.
  EXPECT_NE(told.find(fmt::format("{:.0f} mm,", table.number(2, "com_excursion_mm"))), std::string::npos) << told;
}

void expect_the_far_end_to_follow_its_pull(const fs::path& made) {
  const Csv table(made / "figure14.csv");
  ASSERT_GT(table.rows.size(), 150U);
  double mean_pull = 0, mean_displacement = 0;
  const auto count = static_cast<double>(table.rows.size());
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    mean_pull += table.number(r, "pull_n") / count;
    mean_displacement += table.number(r, "displacement_mm") / count;
  }
  double together = 0, pulls = 0, displacements = 0;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const double p = table.number(r, "pull_n") - mean_pull, d = table.number(r, "displacement_mm") - mean_displacement;
    together += p * d;
    pulls += p * p;
    displacements += d * d;
  }
  EXPECT_GT(together / std::sqrt(pulls * displacements), 0.9);
  const std::size_t last = table.rows.size() - 1;
  EXPECT_NEAR(table.number(0, "displacement_mm"), table.number(last, "displacement_mm"), 1.5);  // steady
}

void expect_every_length_beside_the_published_one(const fs::path& made, const std::string& told) {
  const Csv table(made / "figure15.csv");
  ASSERT_EQ(table.rows.size(), 16 * cycle_points);
  const auto published = read_published_lengths("schwartz_slow");
  double square = 0;
  for (std::size_t i = 0; i < cycle_points; ++i) {
    ASSERT_EQ(table.text(i, "curve"), "schwartz_slow");
    EXPECT_NEAR(table.number(i, "published"), published[0].curve.mean[i], 1e-5);
    if (i + 1 < cycle_points) square += std::pow(table.number(i, "ours") - table.number(i, "published"), 2) / 50;
  }
  EXPECT_LT(std::sqrt(square), 0.03);
  EXPECT_NE(told.find(fmt::format("{:.2f}", 100 * std::sqrt(square))), std::string::npos) << told;
}

TEST(Paper, AllEntriesWriteTablesAndPlotsAndExplainMissingPictures) {
  const TemporaryFolder folder;
  const Ran ran = run_blind("--out all", folder.path);
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const char* entry : {"figure14", "figure15", "weight", "step-length", "quadriceps", "stature"}) {
    const fs::path csv = folder.path / "all" / fmt::format("{}.csv", entry);
    ASSERT_TRUE(fs::exists(csv)) << entry;
    EXPECT_GT(Csv(csv).rows.size(), 2U) << entry;
    expect_plot(folder.path / "all" / fmt::format("{}.svg", entry));
    EXPECT_NE(ran.out.find(fmt::format("{}.svg", entry)), std::string::npos) << entry;
  }
  const fs::path made = folder.path / "all";
  expect_same_speed_and_more_force_for_more_mass(made);
  expect_longer_steps_to_lower_the_centre_of_mass(made, ran.out);
  expect_the_far_end_to_follow_its_pull(made);
  expect_every_length_beside_the_published_one(made, ran.out);
  EXPECT_EQ(ran.out.find("anatomy"), std::string::npos);
  EXPECT_EQ(ran.err.find("mobil"), std::string::npos) << ran.err;  // progress is printed only after ten seconds
  const auto pictures = [&] {
    std::size_t count = 0;
    for (const auto& file : fs::directory_iterator(folder.path / "all")) count += file.path().extension() == ".png";
    return count;
  };
  if (ran.out.find("No pictures: ") == std::string::npos) {
    EXPECT_EQ(pictures(), 5U);
  } else {
    EXPECT_EQ(pictures(), 0U);
    EXPECT_EQ(ran.out.find("No pictures: "), ran.out.rfind("No pictures: ")) << "said more than once";
  }
}

TEST(Paper, PublishedLengthsOfAnUnknownWalkAreAnError) {
  EXPECT_THROW(read_published_lengths("nobody"), Stopped);
}

TEST(Paper, RefusalsListValidNamesAndLeaveNothing) {
  const TemporaryFolder folder;
  expect_refused("paper",
                 {{"figure13", {"there is no entry 'figure13'", "figure14", "stature"}},
                  {"weigth", {"weight"}},
                  {"anatomy", {"--anatomy"}},
                  {"--anatomy nowhere", {"nowhere", "manifest.csv"}},
                  {"--out ''", {"--out"}},
                  {"--colour red", {"--colour"}}},
                 folder.path);
}

TEST(PaperTable, CellsAlignWithHeadsAndTransposedTablesAreEqual) {
  const PaperTable table{
      "who", {{"a_mm", "first\nmm", 1}, {"b", "b", 2}}, {{"naïve", {1.25, 2}}, {"x\ny", {-30, NAN}}}};
  EXPECT_EQ(table_text(table),
            "       first\n"
            "who       mm     b\n"
            "naïve    1.2  2.00\n"
            "x y    -30.0\n");
  EXPECT_EQ(turned_table_text(table),
            "                     x\n"
            "who       naïve      y\n"
            "first mm    1.2  -30.0\n"
            "b          2.00\n");
  EXPECT_EQ(table_csv(table), "who,a_mm,b\nnaïve,1.25,2\nx y,-30,\n");
}

}  // namespace mobil::paper_test
