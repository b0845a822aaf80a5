#pragma once
// Command lines that are refused in one line that names the remedy.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/program/program.h"

namespace mobil::refusals {
namespace fs = std::filesystem;

/// Returns the contents of a folder: names, and bytes of files.
inline std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    found[entry.path().string()] = entry.is_regular_file() ? read_bytes(entry.path()) : "folder";
  }
  return found;
}

/// Expects one refused command line. The message contains all `pieces`, and the folder is unchanged.
inline void expect_refused(const fs::path& folder, const std::string& arguments, const std::vector<std::string>& pieces) {
  SCOPED_TRACE("mobil " + arguments);
  const auto before = contents(folder);
  const Ran ran = run_mobil(arguments, folder);
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
  EXPECT_TRUE(ran.err.ends_with('\n')) << ran.err;
  EXPECT_TRUE(ran.err.starts_with("mobil")) << ran.err;
  EXPECT_LT(ran.err.size(), 400U) << ran.err;
  EXPECT_EQ(ran.out, "");
  for (const auto& piece : pieces) {
    EXPECT_NE(ran.err.find(piece), std::string::npos) << "no '" << piece << "' in: " << ran.err;
  }
  EXPECT_TRUE(contents(folder) == before) << "something was written";
}

inline void expect_refused(const std::string& arguments, const std::vector<std::string>& pieces) {
  const TemporaryFolder folder;
  expect_refused(folder.path, arguments, pieces);
}

}  // namespace mobil::refusals
