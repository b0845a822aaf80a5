// The house rules that a machine can hold: which room may include which, no long file, no stray folder, plain words.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <mobil/version.h>

namespace {
namespace fs = std::filesystem;

const fs::path root = MOBIL_SOURCE_DIR;
const std::string no_folder = ".";  // of files in a room itself: systems/ has its facade there

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

/// Public headers lie as they are installed, in ROOM/include/mobil/, or ROOM/FOLDER/include/mobil/ where the folder is
/// a library that can be left out. Each belongs to a folder of its room: mobil/ROOM/FOLDER/NAME.h says which. What
/// hosts include is mobil/NAME.h and belongs where its source is.
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

/// By the name that sources include them by, <mobil/…>.
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

/// The files of ours that a file includes, as their places ("room/…").
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

TEST(House, IncludesPointDownTheListOfRooms) {
  for (const auto& [room, allowed] : may_include) {
    for (const auto& file : sources(room)) {
      for (const auto& included : includes(file)) {
        const std::string target = included.substr(0, included.find('/'));
        EXPECT_TRUE(allowed.contains(target)) << file << " includes " << included;
      }
    }
  }
}

/// The floors of each room, from the ground up: a folder includes itself and those of the floors below it.
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
    {"demo", {{"examples"},     {"scene"},     {"lab/reference"}, {"program"},      {"measure"},    {"pictures"},
              {"walk"},         {"anatomy"},   {"lab/rivals"},    {"lab/body"},     {"lab/muscle"}, {"lab/compare"},
              {"lab/gait_fit"}, {"lab/paper"}, {"bake"},          {"crowd"},        {"town"},       {"view"},
              {"schedule"},     {"lab/bench"}, {"lab/effects"},   {"lab/frontier"}, {"lab/stress"}, {"lab/completion"},
              {"lab/man"},      {"lab"}}},
};

/// Folders of systems/ whose systems know nothing of each other; modules and the facade may use them all.
const std::set<std::string> kernels = {"gait", "forces", "lines", "activation", "deformation", "render"};

/// The folder of a room that a file (as includes are written) lies in; the laboratory's folders are "lab/NAME".
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

TEST(House, FoldersIncludeOnlyThoseBeforeThem) {
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

/// Only the facade lies in systems/ itself, hello.cpp in demo/, what all tests share in tests/, and nothing in assets/.
TEST(House, EveryFileLiesInAKnownFolder) {
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

/// An installed header needs nothing that is not installed with it.
TEST(House, PublicHeadersIncludePublicOnes) {
  static const std::regex internal("^\\s*#include \"");
  for (const auto& [name, file] : public_headers()) {
    for (const auto& line : lines(file)) EXPECT_FALSE(std::regex_search(line, internal)) << name << ": " << line;
  }
  EXPECT_GT(public_headers().size(), 100U);
}

/// Internal headers that programs outside the laboratory include, until they need them no longer.
const std::set<std::string> still_internal = {};

/// What hosts cannot do, our own programs do not; the laboratory may look inside.
TEST(House, ProgramsIncludePublicHeadersAlone) {
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

/// CMakeLists.txt, version.h and the namespace of every public header say the same.
TEST(House, TheVersionIsOne) {
  static const std::regex opened("^namespace mobil(.*) \\{");
  const std::string version = MOBIL_CMAKE_VERSION;
  const auto minor = version.find('.'), patch = version.find('.', minor + 1);
  const std::string space =
      "::inline v" + version.substr(0, minor) + "_" + version.substr(minor + 1, patch - minor - 1);
  EXPECT_EQ(version, MOBIL_VERSION);
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

/// Sources that have no header of their name beside them, and whose functions those are.
const std::map<std::string, std::string> no_header_yet = {
    {"engine/threads.cpp", "jobs.h"},
    {"systems/c/c_deprecated.cpp", "deprecated.h"},
    {"systems/c/c_lod.cpp", "lod.h"},
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

/// Two types of one name are one to the linker, which takes the functions of either.
TEST(House, TypesOfHeadersHaveNamesOfTheirOwn) {
  static const std::regex type("^(struct|class|union|enum class|enum) (\\w+(?:::\\w+)*)[^;(]*\\{");
  std::map<std::string, fs::path> where;
  for (const auto* room : {"components", "engine", "assets", "systems", "demo"}) {
    for (const auto& file : sources(room)) {
      if (file.extension() != ".h") continue;
      const std::string name = fs::relative(file, root).generic_string();
      if (name.starts_with("demo/examples/") || name.starts_with("demo/lab/rivals/"))
        continue;  // programs of their own
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

TEST(House, ComponentsDependOnTheStandardLibraryAlone) {
  static const std::regex foreign("#include <(hwy|Eigen|fmt|tbb|tl|nlohmann|assimp)");
  for (const auto& file : sources("components")) {
    for (const auto& line : lines(file)) EXPECT_FALSE(std::regex_search(line, foreign)) << file << ": " << line;
  }
}

/// Phrases that a newcomer stumbles on, in comments, messages and documents, and what to say instead.
const std::vector<std::pair<std::string, std::string>> banned = {
    {"all is as it was", "nothing has changed"},
    {"all as it was", "nothing has changed"},
    {"is as it was", "is unchanged"},
    {"stays as it was", "is unchanged"},
    {"are as they were", "are unchanged"},
    {"is no number", "is NaN, or: is not a number"},
    {"number that is none", "NaN"},
    {"numbers that are none", "NaN"},
    {"a camera that is none", "an invalid camera"},
    {"that gives up", "that fails"},
    {"who looks", "the viewer, or: the camera"},
    {"nobody is nearer and cheaper", "Pareto frontier"},
    {"comers and goers", "people who come and go"},
    {"who is told", "who is notified, or: what receives it"},
    {"is told of", "receives, or: reports"},
    {"are told of", "are reported"},
    {"told beside", "given as well"},
    {"front public_header", "facade"},
    {"for the while", "meanwhile, or: until it returns"},
    {"of like build", "of similar build"},
    {"comes to be", "is now, or: becomes"},
    {"whose it is", "its owner"},
    {"gets well again", "recovers"},
    {"so to speak", "leave it out"},
};

/// A file's text in lower case as one line, without the marks of comments and of strings that go on.
std::string prose(const fs::path& file) {
  static const std::regex joint(R"re("?\n\s*(///?<?|\*|#|")?\s*)re");
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  text = std::regex_replace(text, joint, " ");
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

TEST(House, WordsArePlain) {
  static const std::set<std::string> spoken = {".h", ".cpp", ".inl", ".md", ".py", ".js", ".mjs", ".sh", ".txt", ""};
  const auto look = [](const fs::path& file) {
    if (file.filename() == "house_test.cpp" || !spoken.contains(file.extension().string())) return;
    const std::string text = prose(file);
    for (const auto& [phrase, better] : banned) {
      EXPECT_EQ(text.find(phrase), std::string::npos) << file << " says \"" << phrase << "\"; say: " << better;
    }
  };
  for (const auto& [room, allowed] : may_include) {
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      if (entry.is_regular_file()) look(entry.path());
    }
  }
  for (const auto& entry : fs::directory_iterator(root)) {
    if (entry.is_regular_file()) look(entry.path());
  }
}

/// Comments name files by their path from the root.
TEST(House, FilesThatAreNamedAreThere) {
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
