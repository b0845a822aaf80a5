// The house rules that a machine can hold: which room may include which, no long file, no stray folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

const fs::path root = MOBIL_SOURCE_DIR;

const std::map<std::string, std::set<std::string>> may_include = {
    {"components", {"components"}},
    {"engine", {"components", "engine"}},
    {"assets", {"components", "engine", "assets"}},
    {"systems", {"components", "engine", "assets", "systems"}},
    {"demo", {"components", "engine", "assets", "systems", "demo"}},
    {"tests", {"components", "engine", "assets", "systems", "demo", "tests"}},
};

std::vector<fs::path> sources(const std::string& room) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
    const auto extension = entry.path().extension();
    if (extension == ".h" || extension == ".cpp") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::string> lines(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> all;
  for (std::string line; std::getline(in, line);) all.push_back(line);
  return all;
}

/// The files of ours that a file includes, as written ("room/…").
std::vector<std::string> includes(const fs::path& file) {
  static const std::regex include("^\\s*#include \"([^\"]+)\"");
  std::vector<std::string> found;
  for (const auto& line : lines(file)) {
    std::smatch match;
    if (std::regex_search(line, match, include)) found.push_back(match[1]);
  }
  return found;
}

TEST(House, IncludesPointDownTheListOfRooms) {
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) {
      for (const auto& included : includes(file)) {
        const std::string target = included.substr(0, included.find('/'));
        EXPECT_TRUE(allowed.contains(target)) << file << " includes " << included;
        EXPECT_TRUE(fs::exists(root / included)) << file << " includes " << included << ", which is not there";
      }
    }
  }
}

/// A system is a folder of systems/; what lies in systems/ itself is the front door, which knows them all.
TEST(House, NoSystemIncludesAnother) {
  for (const auto& file : sources("systems")) {
    const std::string system = fs::relative(file.parent_path(), root / "systems").string();
    if (system == ".") {
      EXPECT_TRUE(file.stem().string().starts_with("simulation")) << file << " belongs into a system's folder";
      continue;
    }
    for (const auto& included : includes(file)) {
      if (!included.starts_with("systems/")) continue;
      EXPECT_TRUE(included.starts_with("systems/" + system + "/")) << file << " includes " << included;
    }
  }
}

TEST(House, OptionalPartsStayOutOfTheCore) {
  for (const auto* room : {"components", "engine", "assets", "systems"}) {
    for (const auto& file : sources(room)) {
      const bool optional = file.string().find("/import/") != std::string::npos ||
                            file.string().find("/export/") != std::string::npos ||
                            file.string().find("/capture/") != std::string::npos;
      if (optional) continue;
      for (const auto& included : includes(file)) {
        for (const auto* part : {"assets/import/", "assets/export/", "systems/capture/"}) {
          EXPECT_FALSE(included.starts_with(part)) << file << " includes " << included;
        }
      }
    }
  }
}

TEST(House, NoFileIsLongerThan500Lines) {
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) EXPECT_LE(lines(file).size(), 500U) << file;
  }
}

TEST(House, ComponentsDependOnTheStandardLibraryAlone) {
  static const std::regex foreign("#include <(hwy|Eigen|fmt|tbb|tl|nlohmann|assimp)");
  for (const auto& file : sources("components")) {
    for (const auto& line : lines(file)) EXPECT_FALSE(std::regex_search(line, foreign)) << file << ": " << line;
  }
}

TEST(House, NoStrayFolder) {
  const std::set<std::string> known = {"components", "engine", "assets", "systems", "demo",  "tests",
                                       ".ci",        ".git",   "build",  "out",     ".cache"};
  for (const auto& entry : fs::directory_iterator(root)) {
    if (!entry.is_directory()) continue;
    EXPECT_TRUE(known.contains(entry.path().filename().string())) << entry.path();
  }
}
}  // namespace
