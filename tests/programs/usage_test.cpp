// Bad command lines of any subcommand: exit status 2, one line with the remedy. Help lists what exists.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/program/refusals.h"

namespace mobil::usage_test {
using namespace refusals;

TEST(Usage, UnknownNamesAreReportedWithASuggestion) {
  expect_refused("", {"subcommand is missing", "walk", "muscle", "mobil --help"});
  expect_refused("walj", {"'walj'", "walk, crowd", "mobil --help"});
  expect_refused("walj --height 1.8", {"'walj'", "did you mean walk?", "mobil --help"});
  expect_refused("somersault", {"'somersault'", "walk, crowd"});
  expect_refused("walk --hight 1.8 --out out", {"mobil walk:", "--hight", "did you mean --height?"});
  expect_refused("walk --hight=1.8 --out out", {"--hight ", "did you mean --height?"});
  expect_refused("walk --out 1.8 --hight 1.8", {"--hight", "did you mean --height?"});
  expect_refused("walk --steplength 0.7", {"--steplength", "did you mean --step-length?"});
  expect_refused("walk --zzzzzzzz", {"there is no option --zzzzzzzz", "mobil walk --help"});
  expect_refused("muscle --cell 2x2x8", {"mobil muscle:", "--cell ", "did you mean --cells?"});
  expect_refused("walk extra", {"'extra'", "mobil walk --help"});
  expect_refused("--height 1.8 walk", {"--height goes after the subcommand"});
}

TEST(Usage, MissingValueIsRefused) {
  expect_refused("walk --out out --height", {"--height needs one value"});
  expect_refused("muscle --load", {"--load needs one value"});
  for (const std::string option :
       {"height", "mass", "biotype", "speed", "step-length", "seconds", "anatomy", "view", "out"}) {
    expect_refused(fmt::format("walk --{} ''", option), {"--" + option, "empty"});
  }
}

/// Returns the subcommands in a help text, from blocks that begin with "Subcommands:" or "Subcommands of …:".
std::set<std::string> listed(const std::string& help) {
  std::set<std::string> names;
  std::istringstream lines(help);
  std::string line;
  for (bool inside = false; std::getline(lines, line);) {
    if (!line.starts_with("  ")) {
      inside = line.starts_with("Subcommands");
    } else if (inside && line[2] != ' ') {
      names.insert(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return names;
}

TEST(Usage, HelpAtEveryLevelIsComplete) {
  const TemporaryFolder folder;
  const Ran top = run_mobil("--help", folder.path);
  EXPECT_EQ(top.status, 0);
  EXPECT_EQ(top.err, "");
  const auto names = listed(top.out);
  EXPECT_TRUE(names.contains("walk") && names.contains("muscle")) << top.out;
  for (const auto& name : names) {
    const Ran help = run_mobil(name + " --help", folder.path);
    EXPECT_EQ(help.status, 0) << name;
    EXPECT_EQ(help.err, "") << name;
    EXPECT_NE(help.out.find("--help"), std::string::npos) << name;
  }
  // and names that it does not list do not exist
  const Ran none = run_mobil("somersault", folder.path);
  for (const std::string planned : {"body", "effects", "frontier", "crowd", "bench", "robustness"}) {
    const bool there = none.err.find(planned) != std::string::npos;
    EXPECT_EQ(names.contains(planned), there) << planned;
    EXPECT_EQ(run_mobil(planned + " --help", folder.path).status, there ? 0 : 2) << planned;
  }
  EXPECT_EQ(run_mobil("--version", folder.path).status, 0);
  EXPECT_TRUE(contents(folder.path).empty());
}

TEST(BadOutput, AFileIsInTheWay) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "taken") << "mine";
  expect_refused(folder.path, "walk --seconds 0.1 --out taken", {"taken", "--out"});
  expect_refused(folder.path, "walk --seconds 0.1 --out taken/below", {"taken/below", "--out"});
  expect_refused(folder.path, "muscle --seconds 0.01 --out taken/disp.csv", {"taken/disp.csv", "--out"});
  fs::create_directories(folder.path / "folder");
  expect_refused(folder.path, "muscle --seconds 0.01 --out folder", {"folder", "--out"});
  expect_refused(folder.path, "muscle --seconds 0.01 --out nowhere/disp.csv", {"nowhere/disp.csv", "folder"});
}

TEST(BadMuscle, NamesTheLimit) {
  expect_refused("muscle --dt 0.0037", {"0.0037", "critical step 0.003483 s", "0.00313 s"});
  expect_refused("muscle --poisson 0.5", {"0.5", "-0.99 to 0.4999"});
  expect_refused("muscle --poisson nan", {"--poisson", "'nan'"});
  expect_refused("muscle --young 0", {"oung", "0"});
  expect_refused("muscle --density -1", {"ensity", "-1"});
  expect_refused("muscle --cells 2x2", {"'2x2'", "2x2x8"});
  expect_refused("muscle --cells 0x2x2", {"0x2x2", "1 to 256"});
  expect_refused("muscle --cell-size 0", {"--cell-size 0", "0.0001 to 1 m"});
  expect_refused("muscle --method magic", {"'magic'", "explicit-central"});
  expect_refused("muscle --seconds 1e9", {"--seconds 1e9", "3600 s"});
}

TEST(BadMuscle, AFileIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "word.csv") << "time_s,force_x_n,force_y_n,force_z_n\n0,0,much,1\n";
  expect_refused(folder.path, "muscle --load word.csv", {"word.csv"});
  expect_refused(folder.path, "muscle --load nowhere.csv", {"nowhere.csv", "time_s"});
  expect_refused(folder.path, "muscle --load .", {"--load"});
}

TEST(Usage, DeprecatedWordsWorkWithAWarning) {
  const TemporaryFolder folder;
  const std::string_view moved = "muscle --cells 2x2x8 --seconds 0.02 --quiet --out";
  for (const auto& [old, current] :
       std::map<std::string, std::string>{{"--method ecd", "--method explicit-central"},
                                          {"--method=icd", "--method=implicit-central"},
                                          {"--method caa", "--method newmark"},
                                          {"--method reduced --vectors 4", "--method modal --modes 4"}}) {
    const Ran was = run_mobil(fmt::format("{} was.csv {}", moved, old), folder.path);
    const Ran is = run_mobil(fmt::format("{} is.csv {}", moved, current), folder.path);
    EXPECT_EQ(was.status, 0) << was.err;
    EXPECT_EQ(is.status, 0) << is.err;
    EXPECT_NE(was.err.find("' is deprecated; use '"), std::string::npos) << was.err;
    EXPECT_EQ(is.err.find("deprecated"), std::string::npos) << is.err;
    EXPECT_EQ(read_bytes(folder.path / "was.csv"), read_bytes(folder.path / "is.csv")) << old;
  }
}

}  // namespace mobil::usage_test
