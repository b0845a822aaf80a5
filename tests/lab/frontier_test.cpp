// `mobil frontier`: rows on the frontier are not dominated; errors fall as expected; files have the documented columns;
// bad usage is refused before measuring. Run times are not tested.
// The tests share the small frontier, so they run in one process.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "demo/lab/frontier/frontier.h"
#include "demo/pictures/svg_plot.h"
#include "tests/program/program.h"

namespace mobil::frontier_test {
FrontierLevel elements(const char* name, Method method, const Cells& cells, std::optional<double> dt_s = {},
                       bool fixed_step = false) {
  FrontierLevel level{name, {}};
  level.method.choice.method = method;
  level.method.choice.cells = cells;
  level.method.choice.dt_s = dt_s;
  level.method.fixed_step = fixed_step;
  return level;
}

FrontierLevel modal(std::uint32_t modes, bool moving = true) {
  FrontierLevel level{moving ? "modal" : "modal-static", {}};
  level.method.choice.method = Method::modal;
  level.method.choice.modal = {modes, moving, true, {4, 4, 16}};
  return level;
}

/// Returns a request for one muscle of one walker for a second, with few methods.
FrontierRequest tiny_request() {
  FrontierRequest request;
  request.muscles = {Muscle::triceps_surae};
  request.walks = {frontier_walks()[2]};
  request.seconds = 1;
  request.scenes = {false};
  request.reference = {4, 4, 16};
  request.bytes = 1 << 20;
  request.rounds = 1;
  request.threads = 1;
  request.levels = {elements("explicit-central", Method::explicit_central, {2, 2, 8}, 0.002, true),
                    elements("explicit-central", Method::explicit_central, {2, 2, 8}, 0.01, true),
                    elements("explicit-central", Method::explicit_central, {4, 4, 16}),
                    elements("newmark", Method::newmark, {2, 2, 8}),
                    elements("static", Method::statics, {2, 2, 8}),
                    modal(4),
                    modal(12),
                    modal(12, false)};
  request.levels.front().mark = "the paper's choice: 81 nodes, 2 ms";
  return request;
}

const Frontier& tiny() {
  static const Frontier made = measure_frontier(tiny_request());
  return made;
}

const FrontierRow& row(const std::string& method, const std::string& cells, std::uint32_t modes = 0) {
  for (const FrontierRow& r : tiny().rows) {
    if (r.method == method && r.cells == cells && r.modes == modes) return r;
  }
  throw std::runtime_error("no row " + method + " " + cells);
}

TEST(Frontier, ErrorsFallWithTheMeshAndTheVectors) {
  EXPECT_LT(row("explicit-central", "4x4x16").error, row("explicit-central", "2x2x8").error);
  EXPECT_LT(row("modal", "4x4x16", 12).error, row("modal", "4x4x16", 4).error);
  EXPECT_LT(row("modal", "4x4x16", 12).error, row("explicit-central", "2x2x8").error);
  // walks excite waves, which static solutions lack
  EXPECT_GT(row("static", "2x2x8").error, 2 * row("explicit-central", "2x2x8").error);
  EXPECT_GT(row("modal-static", "4x4x16", 12).error, 2 * row("modal", "4x4x16", 12).error);
  for (const FrontierRow& r : tiny().rows) {
    EXPECT_TRUE(r.error > 0 && r.error < 1) << r.method;
    EXPECT_TRUE(r.error_max_m > 0 && r.error_max_m < 0.1) << r.method;
    ASSERT_EQ(r.error_of_muscle.size(), 1U);
    EXPECT_DOUBLE_EQ(r.error_of_muscle[0], r.error);
    EXPECT_TRUE(r.cost_us > 0 && r.points_us > 0 && r.memory_bytes > 0) << r.method;
    EXPECT_EQ(r.uncertain, r.error < 10 * tiny().change[0].own());
  }
}

TEST(Frontier, UnstableLevelsAreLeftOutWithAReason) {
  EXPECT_EQ(tiny().rows.size(), tiny_request().levels.size() - 1);
  ASSERT_EQ(tiny().notes.size(), 1U);
  EXPECT_NE(tiny().notes[0].find("10 ms"), std::string::npos) << tiny().notes[0];
  EXPECT_NE(tiny().notes[0].find("critical step"), std::string::npos) << tiny().notes[0];
}

TEST(Frontier, RatiosReferToTheFirstLevelAndStepsAreAsRequested) {
  const FrontierRow& paper = tiny().rows.front();
  EXPECT_EQ(paper.ratio, 1);
  EXPECT_DOUBLE_EQ(paper.dt_s, 0.002);
  EXPECT_EQ(paper.nodes, 81U);
  for (const FrontierRow& r : tiny().rows) {
    EXPECT_NEAR(r.ratio * r.cost_us, paper.cost_us, 1e-9 * paper.cost_us);
    EXPECT_NEAR(r.points_ratio * r.points_us, paper.cost_us, 1e-9 * paper.cost_us);
  }
  EXPECT_DOUBLE_EQ(row("newmark", "2x2x8").dt_s, frontier_tick_s);
}

/// Compares the mark of each row with a pairwise check.
RC_GTEST_PROP(Frontier, IsTheNonDominatedSet, ()) {
  std::vector<FrontierRow> rows(*rc::gen::inRange<std::size_t>(1, 40));
  for (FrontierRow& r : rows) {
    r.error = *rc::gen::inRange(1, 8) / 8.0;
    r.cost_us = *rc::gen::inRange(1, 8);
    r.points_us = r.cost_us + *rc::gen::inRange(0, 4);
    r.loads = *rc::gen::arbitrary<bool>();
  }
  mark_frontier(rows);
  for (const bool points : {false, true}) {
    for (const FrontierRow& r : rows) {
      const auto cost = [&](const FrontierRow& of) { return points ? of.points_us : of.cost_us; };
      const bool beaten = std::ranges::any_of(rows, [&](const FrontierRow& other) {
        return other.loads == r.loads &&
               ((other.error < r.error && cost(other) <= cost(r)) || (other.error <= r.error && cost(other) < cost(r)));
      });
      RC_ASSERT((points ? r.points_on_frontier : r.on_frontier) == !beaten);
    }
  }
}

TEST(Frontier, CsvHasThePromisedColumnsFirst) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "frontier.csv") << frontier_csv(tiny());
  const Csv csv(folder.path / "frontier.csv");
  const std::vector<std::string> promised = {"method",
                                             "nodes",
                                             "dt_s",
                                             "basis",
                                             "error_rel",
                                             "error_max_m",
                                             "cost_us_per_tick",
                                             "cost_ratio_to_paper",
                                             "memory_bytes",
                                             "on_frontier"};
  ASSERT_GE(csv.columns.size(), promised.size());
  EXPECT_TRUE(std::equal(promised.begin(), promised.end(), csv.columns.begin()));
  ASSERT_EQ(csv.rows.size(), tiny().rows.size());
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const FrontierRow& r = tiny().rows[i];
    EXPECT_EQ(csv.text(i, "method"), r.method);
    EXPECT_NEAR(csv.number(i, "error_rel"), r.error, 1e-5 * r.error);
    EXPECT_EQ(csv.number(i, "on_frontier"), r.on_frontier ? 1 : 0);
    EXPECT_EQ(csv.number(i, "basis"), r.modes);
    EXPECT_EQ(csv.text(i, "loads"), "line");
  }
}

TEST(Frontier, PictureHasTheFrontierInOrderOfCost) {
  const PlotFigure figure = frontier_figure(tiny());
  ASSERT_EQ(figure.panels.size(), 1U);
  for (const PlotLine& line : figure.panels[0].lines) {
    EXPECT_FALSE(line.x.empty());
    EXPECT_TRUE(std::ranges::is_sorted(line.x));
    EXPECT_TRUE(std::ranges::is_sorted(line.y, std::greater{}));
  }
  EXPECT_NE(svg(figure).find("81 nodes"), std::string::npos);
}

TEST(Frontier, BadUsageIsOneLineAndNothingIsWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "taken") << "x";
  expect_refused("frontier",
                 {{"--short --long", {"--short", "--long", "one of them"}},
                  {"--out taken", {"taken", "folder"}},
                  {"--out ''", {"--out"}},
                  {"--out", {"--out needs one value"}},
                  {"--lng", {"--lng", "did you mean --long?"}},
                  {"extra", {"'extra'"}}},
                 folder.path);
}

}  // namespace mobil::frontier_test
