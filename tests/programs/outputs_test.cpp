// Files after a run is interrupted, its reader closes, or its names are invalid.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace mobil {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names(const fs::path& folder) {
  std::set<std::string> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) found.insert(entry.path().filename());
  return found;
}

/// Returns the number of lines of motion.csv, which identifies the run.
std::size_t length_of_motion(const fs::path& out) {
  const std::string text = read_bytes(out / "motion.csv");
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

TEST(Outputs, InterruptedRunLeavesAndChangesNothing) {
  const TemporaryFolder folder;
  const std::string walk = "walk --no-forces --method none --seconds ";
  const Ran all = run_mobil(walk + "1 --frames --video --out whole", folder.path);
  if (all.status == 2 && (all.err.find("EGL") != std::string::npos || all.err.find("ffmpeg") != std::string::npos)) {
    GTEST_SKIP() << all.err;
  }
  ASSERT_EQ(all.status, 0) << all.err;
  const auto whole = names(folder.path / "whole");
  ASSERT_EQ(run_mobil(walk + "0.5 --out old", folder.path).status, 0);
  const auto old = names(folder.path / "old");
  const std::size_t old_rows = length_of_motion(folder.path / "old");

  for (const std::string signal : {"INT", "TERM", "HUP"}) {
    // One signal at every stage of a run; with MOBIL_LONG all signals.
    const bool all_stages = signal == "TERM" || std::getenv("MOBIL_LONG") != nullptr;
    for (const std::string& after_s :
         all_stages ? std::vector<std::string>{"0.03", "0.15", "0.4", "0.9", "1.6"} : std::vector<std::string>{"0.4"}) {
      const std::string said = signal + " after " + after_s + " s";
      for (const std::string out : {"new", "old"}) {
        // --preserve-status: 128 plus the signal.
        const Ran ran = run_shell("timeout --preserve-status -s " + signal + " " + after_s + " '" MOBIL_PROGRAM "' " +
                                      walk + "1 --frames --video --out " + out,
                                  folder.path);
        if (ran.status == 0) {  // a fast machine
          EXPECT_EQ(names(folder.path / out), whole) << said;
          fs::remove_all(folder.path / out);
          if (out == "old") fs::copy(folder.path / "whole", folder.path / "old");
          continue;
        }
        EXPECT_GT(ran.status, 128) << said;
        if (out == "new") {
          // A signal after all files are in place, but before the program ends, leaves complete results.
          if (fs::exists(folder.path / "new")) {
            EXPECT_EQ(names(folder.path / "new"), whole) << said;
          }
          fs::remove_all(folder.path / "new");
        } else if (names(folder.path / "old") != whole) {
          EXPECT_EQ(names(folder.path / "old"), old) << said;
          EXPECT_EQ(length_of_motion(folder.path / "old"), old_rows) << said;
        }
      }
    }
  }
  EXPECT_EQ(run_shell("ps -eo args | grep '[f]fmpeg.*" + folder.path.string() + "'", folder.path).out, "");
}

TEST(Outputs, ClosedReaderIsNotAnError) {
  const TemporaryFolder folder;
  for (const std::string command : {"--help", "walk --list-parameters", "walk --help"}) {
    const Ran ran =
        run_shell("bash -c \"set -o pipefail; '" MOBIL_PROGRAM "' " + command + " | true; exit \\${PIPESTATUS[0]}\"",
                  folder.path);
    EXPECT_EQ(ran.status, 0) << command << ": " << ran.err;
    EXPECT_EQ(ran.err, "") << command;
  }
}

TEST(Outputs, ADeviceIsWrittenTo) {
  const TemporaryFolder folder;
  const Ran ran = run_mobil("muscle --seconds 0.02 --out /dev/null", folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Outputs, InvalidNamesAreRefusedWithStatusTwo) {
  const TemporaryFolder folder;
  fs::create_symlink("loop", folder.path / "loop");
  const std::string longest(300, 'n');
  const std::string quick = "--no-forces --method none --seconds 0.1 ";
  expect_refused("walk",
                 {{quick + "--out loop", {"loop", "--out"}},
                  {quick + "--out loop/below", {"loop"}},
                  {quick + "--out " + longest, {"nnn"}},
                  {quick + "--anatomy " + longest, {"nnn"}},
                  {quick + "--anatomy loop", {"loop"}},
                  {quick + "--anatomy nowhere", {"nowhere"}},
                  {quick + "--script " + longest, {"nnn"}},
                  {quick + "--out /proc/self/nothing", {"/proc/self/nothing"}}},
                 folder.path);
  expect_refused("body", {{"--out loop", {"loop"}}, {"--out " + longest, {"nnn"}}}, folder.path);
  expect_refused("muscle", {{"--seconds 0.02 --out loop", {"loop"}}, {"--seconds 0.02 --out " + longest, {"nnn"}}},
                 folder.path);
  expect_refused("bake", {{"loop", {"loop"}}, {longest + "/" + longest, {"nnn"}}}, folder.path);
}

TEST(Outputs, QuotedMistakesAreShortAndHarmless) {
  const TemporaryFolder folder;
  const std::string red = "$(printf '\\033[31mred')", lines = "$(printf 'two\\nlines')",
                    endless = "$(printf '%050000d' 0)x";
  for (const std::string& value : {red, lines, endless}) {
    for (const std::string command :
         {"walk --height=", "walk --anatomy=", "walk --script=", "walk --set=", "walk --method=", "walk --nonsense=",
          "body --constitution=", "bench ", "nonsense"}) {
      const Ran ran = run_mobil(command + "\"" + value + "\"", folder.path);
      EXPECT_EQ(ran.status, 2) << command << value;
      EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << command << value << ": " << ran.err;
      EXPECT_EQ(ran.err.find('\x1b'), std::string::npos) << command << value;
      EXPECT_LT(ran.err.size(), 2500U) << command << value;
    }
  }
}

}  // namespace
}  // namespace mobil
