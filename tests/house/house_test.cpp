// Checks the house rules: which room includes which, file length, stray folders and plain words.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <mobil/version.h>

namespace {
namespace fs = std::filesystem;

const fs::path root = MOBIL_SOURCE_DIR;
const std::string no_folder = ".";  // for files in a room itself: systems/ has its facade there

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

/// Returns a header's place. Public headers are stored as they are installed, in ROOM/include/mobil/, or in
/// ROOM/FOLDER/include/mobil/ where the folder is an optional library. Each belongs to a folder of its room:
/// mobil/ROOM/FOLDER/NAME.h names that folder. A header that hosts include is mobil/NAME.h and belongs where its source
/// is.
std::string place_of(const fs::path& file) {
  static const std::regex public_header("^(?:([a-z]+)(/[a-z]+)?)/include/mobil/([^/]+)$");
  const std::string name = fs::relative(file, root).generic_string();
  std::smatch match;
  if (std::regex_match(name, match, public_header)) {
    const std::string room = match[1], header = match[3];
    if (match[2].matched) return room + match[2].str() + "/" + header;
    static const auto folder_of_source = [] {
      std::map<std::string, fs::path> folders;  // by "room/stem"
      for (const auto* each : {"components", "engine", "assets", "systems"}) {
        for (const auto& source : sources(each)) {
          if (source.extension() != ".cpp") continue;
          folders[each + ("/" + source.stem().string())] = fs::relative(source, root).parent_path();
        }
      }
      return folders;
    }();
    const auto found = folder_of_source.find(room + "/" + fs::path(header).stem().string());
    return ((found == folder_of_source.end() ? fs::path(room) : found->second) / header).generic_string();
  }
  const auto inside = name.find("/include/mobil/");
  if (inside == std::string::npos) return name;
  const std::string rest = name.substr(inside + std::string("/include/mobil/").size());
  return rest.starts_with("c/") ? "systems/" + rest : rest;
}

/// Public headers by the name in an #include, <mobil/…>.
const std::map<std::string, fs::path>& public_headers() {
  static const auto found = [] {
    std::map<std::string, fs::path> all;
    for (const auto* room : {"components", "engine", "assets", "systems"}) {
      for (const auto& file : sources(room)) {
        const std::string name = file.generic_string();
        const auto inside = name.find("/include/mobil/");
        if (inside != std::string::npos) all[name.substr(inside + std::string("/include/").size())] = file;
      }
    }
    return all;
  }();
  return found;
}

/// Returns the project's own files that a file includes, as places ("room/…").
std::vector<std::string> includes(const fs::path& file) {
  static const std::regex include("^\\s*#include (?:\"([^\"]+)\"|<(mobil/[^>]+)>)");
  std::vector<std::string> found;
  if (file.string().find("/tests/consumer/") != std::string::npos) return found;  // hosts have headers of their own
  for (const auto& line : lines(file)) {
    std::smatch match;
    if (!std::regex_search(line, match, include)) continue;
    if (match[1].matched) {
      found.push_back(match[1]);
      EXPECT_TRUE(fs::exists(root / found.back())) << file << " includes " << found.back() << ", which is not there";
    } else if (const auto header = public_headers().find(match[2]); header != public_headers().end()) {
      found.push_back(place_of(header->second));
    } else {
      ADD_FAILURE() << file << " includes <" << match[2] << ">, which is not there";
    }
  }
  return found;
}

TEST(House, IncludesPointDownTheRoomList) {
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) {
      for (const auto& included : includes(file)) {
        const std::string target = included.substr(0, included.find('/'));
        EXPECT_TRUE(allowed.contains(target)) << file << " includes " << included;
      }
    }
  }
}

/// The floors of each room, from the ground up. A folder includes itself and folders of lower floors.
using Floors = std::vector<std::set<std::string>>;
const std::map<std::string, Floors> order = {
    {"assets",
     {{"fem"},
      {"reduction"},
      {"body"},
      {"gait"},
      {"muscles"},
      {"surfaces"},
      {"finite"},
      {"files"},
      {"import"},
      {"export"}}},
    {"systems",
     {{"limits", "bellies", "accuracy"},
      {"people"},
      {"muscles"},
      {"states"},
      {"poses", "lod", "avoidance", "terrain", "snapshot"},
      {no_folder},
      {"surfaces", "saving", "cluster"},
      {"c"}}},
    {"demo", {{"examples"},   {"scene"},       {"lab/reference"}, {"program"},        {"measure"},
              {"pictures"},   {"walk"},        {"anatomy"},       {"lab/rivals"},     {"lab/body"},
              {"lab/muscle"}, {"lab/compare"}, {"lab/gait_fit"},  {"lab/run_fit"},    {"lab/paper"},
              {"bake"},       {"crowd"},       {"town"},          {"view"},           {"schedule"},
              {"lab/bench"},  {"lab/effects"}, {"lab/frontier"},  {"lab/robustness"}, {"lab/completion"},
              {"lab/man"},    {"lab"}}},
};

/// Folders of systems/ that do not use each other. Modules and the facade can use them all.
const std::set<std::string> kernels = {"gait", "forces", "lines", "activation", "deformation", "render"};

/// Returns the folder of a room that contains a file (as includes are written). The laboratory's are "lab/NAME".
std::string folder_of(const std::string& file) {
  const auto first = file.find('/');
  auto second = file.find('/', first + 1);
  if (const auto third = file.find('/', second + 1); file.starts_with("demo/lab/") && third != std::string::npos) {
    second = third;
  }
  return second == std::string::npos ? no_folder : file.substr(first + 1, second - first - 1);
}

bool folder_may_include(const std::string& room, const std::string& folder, const std::string& included) {
  if (folder == included) return true;
  if (room == "systems" && kernels.contains(folder)) return false;
  if (room == "systems" && kernels.contains(included)) return true;
  const Floors& floors = order.at(room);
  const auto has = [](const std::string& name) { return [&](const auto& floor) { return floor.contains(name); }; };
  const auto own = std::ranges::find_if(floors, has(folder));
  return std::find_if(floors.begin(), own, has(included)) != own;
}

TEST(House, FoldersIncludeOnlyLowerFloors) {
  for (const auto& [room, floors] : order) {
    EXPECT_TRUE(room != "systems" || floors.size() <= 8);
    for (const auto& file : sources(room)) {
      const std::string name = place_of(file);
      for (const auto& included : includes(file)) {
        if (!included.starts_with(room + "/")) continue;
        EXPECT_TRUE(folder_may_include(room, folder_of(name), folder_of(included))) << name << " includes " << included;
      }
    }
  }
}

/// Only the facade is in systems/ itself, hello.cpp in demo/, files common to all tests in tests/, and nothing in
/// assets/.
TEST(House, EveryFileIsInAKnownFolder) {
  for (const auto* room : {"assets", "systems", "demo", "tests"}) {
    for (const auto& file : sources(room)) {
      const std::string name = place_of(file), folder = folder_of(name);
      if (folder == no_folder) {
        EXPECT_TRUE(name.starts_with("systems/simulation") || name.starts_with("systems/standard_modules") ||
                    name == "systems/host_parts.h" || name == "systems/step_report.h" || name == "demo/hello.cpp" ||
                    name.starts_with("tests/"))
            << name << " belongs into a folder";
      } else if (order.contains(room)) {
        const bool kernel = room == std::string("systems") && kernels.contains(folder);
        const auto known = [&](const auto& floor) { return floor.contains(folder); };
        EXPECT_TRUE(kernel || std::ranges::any_of(order.at(room), known))
            << name << " lies in a folder that house_test.cpp does not know";
      }
    }
  }
}

/// An installed header includes only installed headers.
TEST(House, PublicHeadersIncludePublicOnes) {
  static const std::regex internal("^\\s*#include \"");
  for (const auto& [name, file] : public_headers()) {
    for (const auto& line : lines(file)) EXPECT_FALSE(std::regex_search(line, internal)) << name << ": " << line;
  }
  EXPECT_GT(public_headers().size(), 100U);
}

/// Every source of a host compiles simulation.h.
TEST(House, SimulationIncludesFewHeaders) {
  static const std::regex include("^#include <(mobil/[^>]+)>");
  std::set<std::string> seen;
  for (std::vector<std::string> left = {"mobil/simulation.h"}; !left.empty();) {
    const std::string name = left.back();
    left.pop_back();
    for (const auto& line : lines(public_headers().at(name))) {
      std::smatch match;
      if (std::regex_search(line, match, include) && seen.insert(match[1]).second) left.push_back(match[1]);
    }
  }
  EXPECT_TRUE(seen.contains("mobil/engine/entity.h"));  // behind others
  EXPECT_LE(seen.size(), 15U);
}

/// Internal headers that programs outside the laboratory still include.
const std::set<std::string> still_internal = {};

/// The project's programs use only what hosts can use. The laboratory can include internal headers.
TEST(House, ProgramsIncludeOnlyPublicHeaders) {
  static const std::regex internal("^\\s*#include \"((?:components|engine|assets|systems)/[^\"]+)\"");
  std::set<std::string> needed;
  for (const auto& file : sources("demo")) {
    if (fs::relative(file, root).generic_string().starts_with("demo/lab/")) continue;
    for (const auto& line : lines(file)) {
      std::smatch match;
      if (!std::regex_search(line, match, internal)) continue;
      EXPECT_TRUE(still_internal.contains(match[1])) << file << " includes " << match[1] << ", which is internal";
      needed.insert(match[1]);
    }
  }
  for (const auto& header : still_internal) EXPECT_TRUE(needed.contains(header)) << "no program includes " << header;
}

/// CMakeLists.txt, version.h, the npm package and the namespace of every public header contain the same version.
TEST(House, VersionIsTheSameEverywhere) {
  static const std::regex opened("^namespace mobil(.*) \\{");
  const std::string version = MOBIL_CMAKE_VERSION;
  const auto minor = version.find('.'), patch = version.find('.', minor + 1);
  const std::string space =
      "::inline v" + version.substr(0, minor) + "_" + version.substr(minor + 1, patch - minor - 1);
  EXPECT_EQ(version, MOBIL_VERSION);
  const auto package = lines(root / "systems/javascript/package.json");
  EXPECT_TRUE(std::ranges::count(package, "  \"version\": \"" + version + "\",") == 1) << "package.json of npm";
  for (const auto* room : {"components", "engine", "assets", "systems"}) {
    for (const auto& file : sources(room)) {
      for (const auto& line : lines(file)) {
        std::smatch match;
        if (!std::regex_search(line, match, opened)) continue;
        EXPECT_TRUE(match[1].str().starts_with(space)) << file << ": " << line;
      }
    }
  }
}

TEST(House, OptionalPartsStayOutOfTheCore) {
  for (const auto* room : {"components", "engine", "assets", "systems"}) {
    for (const auto& file : sources(room)) {
      const bool optional = file.string().find("/import/") != std::string::npos ||
                            file.string().find("/export/") != std::string::npos ||
                            file.string().find("/render/") != std::string::npos;
      if (optional) continue;
      for (const auto& included : includes(file)) {
        for (const auto* part : {"assets/import/", "assets/export/", "systems/render/"}) {
          EXPECT_FALSE(included.starts_with(part)) << file << " includes " << included;
        }
      }
    }
  }
}

/// Sources without a header of their name, and the header that declares their functions.
const std::map<std::string, std::string> no_header_yet = {
    {"engine/threads.cpp", "jobs.h"},
    {"assets/gait/step_table_man.cpp", "step_table.h"},
    {"assets/gait/step_table_woman.cpp", "step_table.h"},
    {"assets/gait/step_table_child.cpp", "step_table.h"},
    {"engine/highway_targets.cpp", "hwy/targets.h"},
    {"systems/c/c_deprecated.cpp", "deprecated.h"},
    {"systems/c/c_lod.cpp", "lod.h"},
    {"systems/c/c_body.cpp", "body.h"},
    {"systems/surfaces/baked_skins.cpp", "skin_writer.h"},
    {"systems/c/c_skin_binding.cpp", "skin.h"},
    {"systems/c/c_contacts.cpp", "mobil_skin.h"},
    {"systems/c/c_muscles.cpp", "mobil.h"},
    {"systems/c/c_custom_skin.cpp", "mobil_skin.h"},
    {"systems/c/c_people.cpp", "mobil.h"},
    {"systems/c/c_play.cpp", "mobil_play.h"},
    {"systems/c/c_reading.cpp", "mobil.h"},
    {"systems/c/c_simulation.cpp", "mobil.h"},
    {"systems/c/c_surroundings.cpp", "mobil_surroundings.h"},
    {"systems/deformation/explicit.cpp", "deformation.h"},
    {"systems/deformation/implicit.cpp", "deformation.h"},
    {"systems/deformation/modal_report.cpp", "modal.h"},
    {"systems/gait/gait_advance.cpp", "gait.h"},
    {"systems/gait/step_plan.cpp", "gait.h"},
    {"systems/lod/lod_budget.cpp", "lod_round.h"},
    {"systems/lod/lod_choice.cpp", "lod_round.h"},
    {"systems/lod/lod_sleep.cpp", "lod_round.h"},
    {"systems/bellies/belly_library_baked.cpp", "belly_library.h"},
    {"systems/bellies/belly_library_bases.cpp", "belly_library.h"},
    {"systems/bellies/belly_library_prepare.cpp", "belly_library.h"},
};

/// The linker merges types of one name and links the functions of either.
TEST(House, HeaderTypesHaveUniqueNames) {
  static const std::regex type("^(struct|class|union|enum class|enum) (\\w+(?:::\\w+)*)[^;(]*\\{");
  std::map<std::string, fs::path> where;
  for (const auto* room : {"components", "engine", "assets", "systems", "demo"}) {
    for (const auto& file : sources(room)) {
      if (file.extension() != ".h") continue;
      const std::string name = fs::relative(file, root).generic_string();
      if (name.starts_with("demo/examples/") || name.starts_with("demo/lab/rivals/")) continue;  // separate programs
      std::string space;
      for (const auto& line : lines(file)) {
        if (line.starts_with("namespace ")) space = line.substr(0, line.find(" {"));
        std::smatch match;
        if (!std::regex_search(line, match, type)) continue;
        const auto [first, added] = where.emplace(space + "::" + match[2].str(), file);
        EXPECT_TRUE(added || first->second == file) << match[2] << " is in " << first->second << " and in " << file;
      }
    }
  }
  EXPECT_GT(where.size(), 500U);
}

TEST(House, EverySourceHasAHeaderOfItsName) {
  std::set<std::string> without, headers;
  for (const auto* room : {"engine", "assets", "systems"}) {
    for (const auto& file : sources(room)) {
      if (file.extension() == ".h") headers.insert(place_of(file));
    }
    for (const auto& file : sources(room)) {
      if (file.extension() != ".cpp") continue;
      const std::string name = fs::relative(file, root).generic_string();
      if (headers.contains(fs::path(place_of(file)).replace_extension(".h").generic_string())) continue;
      EXPECT_TRUE(no_header_yet.contains(name)) << name << " has no header of its name";
      without.insert(name);
    }
  }
  for (const auto& [name, declared_in] : no_header_yet) {
    EXPECT_TRUE(without.contains(name)) << name << " has a header of its name, or is gone (" << declared_in << ")";
  }
}

TEST(House, NoFileIsLongerThan500Lines) {
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) EXPECT_LE(lines(file).size(), 500U) << file;
  }
}

TEST(House, ComponentsDependOnlyOnTheStandardLibrary) {
  static const std::regex foreign("#include <(hwy|Eigen|fmt|tl|nlohmann|assimp)");
  for (const auto& file : sources("components")) {
    for (const auto& line : lines(file)) EXPECT_FALSE(std::regex_search(line, foreign)) << file << ": " << line;
  }
}

/// Other ways to print throw if a stream is full or closed.
TEST(House, ProgramsPrintThroughTheConsole) {
  static const std::regex other("\\bstd(out|err)\\b|std::c(out|err|log)\\b|fmt::print|\\b(f?printf|f?puts)\\(");
  for (const auto& file : sources("demo")) {
    const std::string name = fs::relative(file, root / "demo").generic_string();
    if (name == "hello.cpp" || name.starts_with("examples/") || name.starts_with("lab/rivals/")) continue;
    for (const auto& line : lines(file)) {
      if (line.find("//") != std::string::npos) continue;
      EXPECT_FALSE(std::regex_search(line, other)) << name << ": " << line;
    }
  }
}

/// Comments name files by their path from the root.
TEST(House, NamedFilesExist) {
  static const std::regex named(
      "\\b(?:components|engine|assets|systems|demo|tests)/[A-Za-z0-9_/-]+\\.(?:h|cpp|md|sh|py)\\b");
  std::set<std::string> places;
  for (const auto& [name, header] : public_headers()) places.insert(place_of(header));
  std::size_t found = 0;
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) {
      for (const auto& line : lines(file)) {
        if (line.starts_with("#include")) continue;
        for (std::sregex_iterator at(line.begin(), line.end(), named), end; at != end; ++at, ++found) {
          const bool there = fs::exists(root / at->str()) || places.contains(at->str());
          EXPECT_TRUE(there) << file << " names " << at->str();
        }
      }
    }
  }
  EXPECT_GT(found, 200U);
}

TEST(House, NoStrayFolder) {
  const std::set<std::string> known = {"components", "engine", "assets",  "systems", "demo", "tests",
                                       ".ci",        ".git",   ".github", "build",   "out",  ".cache"};
  for (const auto& entry : fs::directory_iterator(root)) {
    if (!entry.is_directory()) continue;
    EXPECT_TRUE(known.contains(entry.path().filename().string())) << entry.path();
  }
}
}  // namespace
