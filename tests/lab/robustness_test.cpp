// `mobil robustness`: every hard case holds, each row shows its figures, and bad input is refused before anything runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "demo/lab/robustness/robustness.h"
#include "tests/program/program.h"

namespace mobil::robustness_test {
namespace fs = std::filesystem;

/// Returns the first word of every line of `mobil robustness --list`.
std::vector<std::string> listed() {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("robustness --list", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  std::vector<std::string> names;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) names.push_back(line.substr(0, line.find(' ')));
  return names;
}

TEST(Robustness, EveryRowHoldsAndIsReported) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("robustness --quick --quiet --json robustness.json", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_EQ(ran.err, "");
  const auto json = nlohmann::json::parse(read_bytes(folder.path / "robustness.json"));
  EXPECT_TRUE(json.at("quick").get<bool>());
  EXPECT_EQ(json.at("broken"), 0);
  EXPECT_EQ(json.at("held"), json.at("rows").size());
  std::set<std::string> told;
  for (const auto& row : json.at("rows")) {
    told.insert(row.at("name").get<std::string>());
    for (const auto* text : {"tried", "promised", "reason", "happened", "quantity"}) {
      EXPECT_FALSE(row.at(text).get<std::string>().empty()) << row;
    }
    EXPECT_TRUE(row.at("held").get<bool>()) << row;
    const double bound = row.at("bound").get<double>();
    const auto& value = row.at("value");
    const double measured = value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity();
    if (row.at("promise") == "at most") {
      EXPECT_LE(measured, bound) << row;
    } else {
      EXPECT_GE(measured, bound) << row;
    }
    EXPECT_NE(ran.out.find(row.at("tried").get<std::string>()), std::string::npos) << row;
  }
  const auto names = listed();
  EXPECT_EQ(told, std::set<std::string>(names.begin(), names.end()));
  const auto lines = static_cast<std::size_t>(std::ranges::count(ran.out, '\n'));
  EXPECT_EQ(lines, json.at("rows").size() + 1) << "a line each and the count";
}

TEST(Robustness, RunsNamedCases) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("robustness --quick nan inverted", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("held  inverted"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("held  nan"), std::string::npos) << ran.out;
  EXPECT_LT(ran.out.find("held  inverted"), ran.out.find("held  nan"));
  EXPECT_EQ(ran.out.find("slivers"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 0);
}

TEST(Robustness, ListRunsNothing) {
  const auto names = listed();
  EXPECT_GE(names.size(), 20U);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Robustness, NanNeverHolds) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Promise promise : {Promise::at_most, Promise::at_least}) {
    EXPECT_FALSE((RobustnessRow{"", "", promise, 1, "", none}.held()));
    EXPECT_TRUE((RobustnessRow{"", "", promise, 1, "", 1}.held()));
  }
  EXPECT_FALSE((RobustnessRow{"", "", Promise::at_most, 1, "", 1.001}.held()));
  EXPECT_FALSE((RobustnessRow{"", "", Promise::at_least, 1, "", 0.999}.held()));
}

TEST(Robustness, BadInputIsOneLineAndNothingRuns) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path / "taken");
  const std::map<std::string, std::vector<std::string>> refused = {
      {"slivrs", {"'slivrs'", "did you mean slivers?", "energy-single"}},
      {"nan somersault", {"'somersault'", "slivers, aspect"}},
      {"nan --json", {"--json needs one value"}},
      {"nan --json ''", {"--json", "empty"}},
      {"nan --json nowhere/robustness.json", {"--json nowhere/robustness.json", "folder"}},
      {"nan --json taken", {"--json taken", "folder"}},
      {"nan --quik", {"--quik", "did you mean --quick?"}},
  };
  expect_refused("robustness", refused, folder.path);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), 1);
}

}  // namespace mobil::robustness_test
