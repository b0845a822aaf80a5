// Comments and documents are plain English: each room has a ceiling for sentences with a construction that engineers of
// the field do not write. Lower a ceiling when the count sinks; never raise one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace mobil::prose_test {
namespace {

namespace fs = std::filesystem;
const fs::path root(MOBIL_SOURCE_DIR);

/// Sentences that match a pattern, at most, by room; `documents` are the files in the root.
const std::map<std::string, std::size_t> ceilings = {{"components", 0}, {"engine", 0}, {"assets", 1},   {"systems", 18},
                                                     {"demo", 4},       {"tests", 17}, {"documents", 0}};
/// Installed headers have none.
constexpr std::size_t header_ceiling = 0;

struct Pattern {
  std::string better;
  std::regex is;
};

const std::vector<Pattern>& patterns() {
  static const auto made = [] {
    const auto flags = std::regex::ECMAScript | std::regex::optimize;
    return std::vector<Pattern>{
        {"name the person, row or caller instead of \"who\"",
         std::regex(
             R"(^(?:And |But )?Who(?:m|se|ever)? (?!.*\?$)|\b(?:of|for|to|by|from|with|and|as|than|that|:) who(?:m|ever)? )",
             flags)},
        {"open with a noun or a verb", std::regex(R"(^(?:What|Whatever|Whether|Where|How) (?!.*\?$))", flags)},
        {"open with a noun or a verb, not with \"Of\"", std::regex(R"(^Of (?!course))", flags)},
        {"name the thing instead of \"what\"",
         std::regex(R"(\b(?:of|from|for|to|by|with|and|than|in|on|as|is|are|beside|at) what\b)", flags)},
        {"\"no caller\", \"all people\", \"a person\"",
         std::regex(R"(\b(?:[Nn]obody|[Ss]omebody|[Aa]nybody|[Ee]verybody)\b)", flags)},
        {"\"except\", \"nearly\", \"because\"",
         std::regex(
             R"(\b(?:all but|but for|none but|nothing but|is but|anything but)\b|, for (?:it|they|there|he|she|no|then|that|this|these|those|floats|places|what|who|its|their|a \w+ that)\b)",
             flags)},
        {"\"is not a\"", std::regex(R"(\b(?:is|are|was|were) (?:no|none)\b(?! longer| more))", flags)},
        {"a factor, or the old and the new value",
         std::regex(
             R"(\b(?:takes?|took|in) (?:a|an|the|two|three|four|seven|half) (?:half|third|quarter|fifth|sixth|eighth|tenth|thirds|quarters|tenths|part)s? of\b)",
             flags)},
        {"\"differently\", \"relative to\", \"also\", \"instead of\", \"again\"",
         std::regex(R"(\b(?:otherwise than|other than as|beside|besides|likewise|in place of|anew|hence|thereby)\b)",
                    flags)},
        {"\"continues\", \"moves with it\", \"is reset\"",
         std::regex(R"(\b(?:go|goes|went|going|gone) (?:on|along|away|with)\b|\bbegins? (?:anew|again|at rest)\b)",
                    flags)},
        {"\"minimum\", \"maximum\"", std::regex(R"(\b(?:the least|the most|at the most|least of)\b)", flags)},
        {"say what differs", std::regex(R"(^(?:The same|Likewise|As (?:above|before|the other|its|their))\b)", flags)},
    };
  }();
  return made;
}

std::size_t words(const std::string& text) {
  std::size_t count = 0;
  bool in_word = false;
  for (const char c : text) {
    const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
    count += !space && !in_word ? 1 : 0;
    in_word = !space;
  }
  return count;
}

/// Returns the remedy for a sentence, or an empty string.
std::string remedy(const std::string& sentence) {
  static const std::regex code(R"(`[^`]*`|\([^)]*\.(?:h|md|cpp)[^)]*\))");
  const std::string plain = std::regex_replace(sentence, code, "X");
  if (words(plain) > 35) return "at most 25 words";
  std::size_t colons = 0;
  for (std::size_t i = 0; i < plain.size(); ++i)
    colons += plain[i] == ':' && plain.substr(i, 2) != "::" && (i == 0 || plain[i - 1] != ':') ? 1 : 0;
  if (colons > 1) return "one colon";
  for (const Pattern& pattern : patterns())
    if (std::regex_search(plain, pattern.is)) return pattern.better;
  return {};
}

/// Splits a paragraph after each . ; ! or ? that ends a word.
std::vector<std::string> sentences(const std::string& paragraph) {
  std::vector<std::string> all(1);
  for (std::size_t i = 0; i < paragraph.size(); ++i) {
    if (all.back().empty() && paragraph[i] == ' ') continue;
    all.back() += paragraph[i];
    const bool ends = std::string_view(".;!?").find(paragraph[i]) != std::string_view::npos;
    if (ends && (i + 1 == paragraph.size() || paragraph[i + 1] == ' ')) all.emplace_back();
  }
  std::erase_if(all, [](const std::string& one) { return words(one) < 3; });
  return all;
}

/// Returns the paragraphs of a file's comments, or of a Markdown document outside code.
std::vector<std::string> paragraphs(const fs::path& file) {
  static const std::regex slashes(R"(^\s*(?:///?<?|\*)\s?(.*)$)"), hash(R"(^\s*#(?!!)\s?(.*)$)"),
      tail(R"([;{},)]\s*///?<?\s?(.*)$)"), item(R"(^(?:[-*]|\d+\.|#+) )");
  const bool markdown = file.extension() == ".md";
  const bool scripted =
      file.extension() == ".py" || file.extension() == ".sh" || file.extension() == ".txt" || file.extension().empty();
  std::vector<std::string> all(1);
  const auto end = [&] {
    if (!all.back().empty()) all.emplace_back();
  };
  const auto add = [&](const std::string& text) { all.back() += (all.back().empty() ? "" : " ") + text; };
  bool in_code = false;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::smatch found;
    if (markdown) {
      if (line.starts_with("```")) in_code = !in_code;
      const std::size_t first = line.find_first_not_of(' ');
      if (in_code || line.starts_with("    ") || first == std::string::npos || line.starts_with("```")) {
        end();
        continue;
      }
      line = line.substr(first);
      if (line[0] == '|') {
        end();
        for (std::size_t from = 1, to; from < line.size(); from = to + 1) {
          to = std::min(line.find('|', from), line.size());
          add(line.substr(from, to - from));
          end();
        }
        continue;
      }
      if (std::regex_search(line, found, item)) end();
      add(std::regex_replace(line, item, ""));
    } else if (std::regex_match(line, found, scripted ? hash : slashes)) {
      const std::string text = found[1];
      text.starts_with("  ") ? end() : add(text);  // a drawing, an equation or code
    } else {
      end();
      if (!scripted && std::regex_search(line, found, tail)) {
        add(found[1]);
        end();
      }
    }
  }
  return all;
}

/// Appends the sentences of a file that match, each with its place and the remedy.
void look(const fs::path& file, std::vector<std::string>& found) {
  static const std::set<std::string> kinds = {".h", ".cpp", ".c", ".js", ".mjs", ".md", ".py", ".sh"};
  const std::string name = file.filename().string();
  if (!kinds.contains(file.extension().string()) && name != "CMakeLists.txt" && name != "run") return;
  for (const std::string& paragraph : paragraphs(file)) {
    for (const std::string& sentence : sentences(paragraph)) {
      const std::string better = remedy(sentence);
      if (!better.empty())
        found.push_back(fs::relative(file, root).string() + ": \"" + sentence + "\" (" + better + ")\n");
    }
  }
}

TEST(Prose, SentencesOfEachRoomStayBelowTheCeiling) {
  std::vector<std::string> in_headers;
  for (const auto& [room, ceiling] : ceilings) {
    std::vector<std::string> found;
    if (room == "documents") {
      for (const auto& entry : fs::directory_iterator(root)) look(entry.path(), found);
    } else {
      for (const auto& entry : fs::recursive_directory_iterator(root / room)) look(entry.path(), found);
    }
    EXPECT_LE(found.size(), ceiling) << room << ":\n" << std::accumulate(found.begin(), found.end(), std::string());
    std::ranges::copy_if(found, std::back_inserter(in_headers), [](const std::string& one) {
      return one.substr(0, one.find(": ")).find("/include/mobil/") != std::string::npos;
    });
  }
  EXPECT_LE(in_headers.size(), header_ceiling) << "installed headers:\n"
                                               << std::accumulate(in_headers.begin(), in_headers.end(), std::string());
}

TEST(Prose, PatternsFindDialectAndPassEnglish) {
  for (const char* bad :
       {"Who stands does so.", "What both arms share.", "Of a camera: pixels.", "It depends on what the caller gave.",
        "Nobody waits for it.", "The rows, all but one, are equal.", "It is no number.",
        "This takes a third of the time.", "It moves beside the leg.", "The walk goes on unchanged.",
        "Here is the least that fits.", "The same of many people."})
    EXPECT_FALSE(remedy(bad).empty()) << bad;
  for (const char* good : {"Returns the pose of a person, in the world frame.", "Half-angle of the view cone, rad.",
                           "A standing walker uses level-ground posture.", "Rows that are not moved keep their place."})
    EXPECT_EQ(remedy(good), "") << good;
}

}  // namespace
}  // namespace mobil::prose_test
