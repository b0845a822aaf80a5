// Bad input to the program itself: exit status 2, one line that names the mistake and its remedy, no file written. Help
// lists what exists.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <mobil/components/gait.h>
#include "tests/labels.h"
#include "tests/program/refusals.h"

MOBIL_TEST_LABELS("long");

namespace mobil::cli_test {
using namespace refusals;
namespace fs = std::filesystem;

TEST(BadBody, NamesValueRangeAndUnit) {
  expect_refused("walk --height 0 --out out", {"--height 0", "1.2 to 2.2 m"});
  expect_refused("walk --height nan --out out", {"--height 'nan'", "finite", "cm"});
  expect_refused("walk --height inf --out out", {"--height 'inf'", "finite"});
  expect_refused("walk --height 1e999 --out out", {"--height '1e999'", "finite"});
  expect_refused("walk --height -3 --out out", {"--height -3", "1.2 to 2.2 m"});
  expect_refused("walk --height 12m --out out", {"--height 12m", "1.2 to 2.2 m"});
  expect_refused("walk --height 1.80s --out out", {"1.80s", "unit", "cm"});
  expect_refused("walk --height tall --out out", {"'tall'", "m, cm, mm"});
  expect_refused("walk --mass 5 --out out", {"--mass 5", "30 to 200 kg"});
  expect_refused("walk --biotype 2-5 --out out", {"'2-5'", "0.1 to 12"});
  expect_refused("walk --biotype 2-5-99 --out out", {"'2-5-99'", "0.1 to 12"});
  expect_refused("walk --constitution burly --out out", {"'burly'", "thin, average, athletic, heavy"});
}

TEST(BadGait, NamesTheRequestedValue) {
  expect_refused("walk --speed 9m/s --out out", {"speed of 9 m/s", "–", "m/s", "1.75 m"});
  expect_refused("walk --speed 0 --step-length 0.7 --out out", {"speed", "positive", "0 to stand"});
  expect_refused("walk --speed -1 --out out", {"--speed -1", "m/s"});
  expect_refused("walk --speed 5m --out out", {"'5m'", "km/h"});
  expect_refused("walk --step-length 3m --out out", {"step length of 3 m", "m for a height of"});
  expect_refused("walk --step-length 40 --out out", {"--step-length 40", " m;"});
  expect_refused("walk --step-frequency 9 --out out", {"step frequency of 9 Hz"});
  expect_refused("walk --speed 1.4 --step-length 0.7 --step-frequency 3 --out out",
                 {"1.4 m/s", "0.7 m", "3 Hz", "leave one of the three out"});
  expect_refused("walk --speed 0.5 --step-length 1 --out out", {"step", "Hz"});
  expect_refused("walk --seconds 0 --out out", {"--seconds 0", "0.1 to 60 s"});
  expect_refused("walk --drive elastic --out out", {"'elastic'", "displacement, force"});
  expect_refused("walk --view xray --out out", {"'xray'", "stick, wireframe, surface"});
}

TEST(BadParameter, NamesTheNearestNameTheRangeAndTheList) {
  expect_refused("walk --set toe_out=3 --out out", {"--set toe_out", "did you mean toe_out_deg?", "--list-parameters"});
  expect_refused("walk --set step_widht_h=0.1 --out out", {"did you mean step_width_h?", "--list-parameters"});
  expect_refused("walk --set zzz=3 --out out", {"--set zzz", "--list-parameters"});
  expect_refused("walk --set toe_out_deg --out out", {"'toe_out_deg'", "NAME=VALUE"});
  expect_refused("walk --set toe_out_deg=10 --set toe_out_deg=40 --out out", {"toe_out_deg 40", "-15 to 30 deg"});
  expect_refused("walk --set toe_out_deg=10kg --out out", {"'kg'", "deg"});
  expect_refused("walk --set toe_out_deg= --out out", {"toe_out_deg ''", "number"});
  expect_refused("walk --set toe_out_deg=1 toe_clearance_m=0 --out out", {"'toe_clearance_m=0' was not expected"});
}

TEST(Listing, GaitParametersAndNothingElse) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("walk --list-parameters", folder.path);
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  for (const GaitParameter& p : gait_parameters)
    EXPECT_NE(ran.out.find(fmt::format("\n  {} ", p.name)), std::string::npos);
  EXPECT_TRUE(contents(folder.path).empty());
}

TEST(BadOutput, AFolderHasTheNameOfAResult) {
  for (const std::string name : {"motion.csv", "muscles.csv", "walk.glb", "summary.json"}) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path / "out" / name / "inside");
    const Ran ran = run_mobil("walk --seconds 0.1 --out out", folder.path);
    EXPECT_EQ(ran.status, 2) << name;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_NE(ran.err.find(name), std::string::npos) << ran.err;
    for (const auto& entry : fs::directory_iterator(folder.path / "out")) {  // no file under a temporary name
      const std::set<std::string> final_names = {"motion.csv", "muscles.csv", "walk.glb", "summary.json"};
      EXPECT_TRUE(final_names.contains(entry.path().filename().string())) << entry.path();
    }
  }
}

TEST(BadOutput, WithoutFfmpegOrDriverNothingIsWritten) {
  const TemporaryFolder folder;
  for (const std::string refused :
       {"PATH=/nowhere '" MOBIL_PROGRAM "' walk --seconds 0.1 --video --out out",
        "__EGL_VENDOR_LIBRARY_DIRS=/nowhere '" MOBIL_PROGRAM "' walk --seconds 0.1 --frames --out out"}) {
    const Ran ran = run_shell(refused, folder.path);
    if (ran.status == 0 && refused.find("EGL") != std::string::npos) GTEST_SKIP() << "this driver cannot be hidden";
    EXPECT_EQ(ran.status, 2) << refused;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    EXPECT_NE(ran.err.find("apt-get install"), std::string::npos) << ran.err;
    EXPECT_TRUE(contents(folder.path).empty()) << refused;
  }
}

TEST(BadWalk, NamesTheMethodsAndElements) {
  expect_refused("walk --method magic", {"--method", "'magic'", "static, explicit-central, implicit-central, newmark"});
  expect_refused("walk --element cube", {"--element", "'cube'", "full, bbar, one-point"});
}

/// Mistakes inside files are refused by their readers (Script).
TEST(BadFile, IsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "short.csv") << "time_s,parameter,value\n1,stop\n";
  expect_refused(folder.path, "walk --script short.csv --out out", {"--script", "short.csv", "line 2: 2 cells"});
  expect_refused(folder.path, "walk --script nowhere.csv --out out", {"nowhere.csv", "time_s, parameter, value"});
}

}  // namespace mobil::cli_test
