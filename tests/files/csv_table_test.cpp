// Tables as spreadsheets write them: separators, encodings, line ends, quotes, empty rows.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include <mobil/assets/files/csv_table.h>
#include "tests/refused.h"

namespace mobil::csv_table_test {

constexpr std::array<std::string_view, 3> required = {"name", "x", "unit"};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string utf16(const std::u16string& text, bool big) {
  std::string bytes;
  for (const char16_t unit : u"\uFEFF" + text) {
    const char low = static_cast<char>(unit & 255), high = static_cast<char>(unit >> 8);
    bytes += big ? std::string{high, low} : std::string{low, high};
  }
  return bytes;
}

TEST(CsvTable, EverySpreadsheetsSpellingIsTheSameTable) {
  const std::string text = "name,x,unit\nhip joint,-82.5,mm\n\"knee, right\",1e2,mm\n";
  const std::string semicolons = "name;x;unit\nhip joint;-82,5;mm\nknee, right;1e2;mm\n";
  std::vector<std::string> all = {text, "\xEF\xBB\xBF" + text, semicolons, "sep=;\n" + semicolons,
                                  "\"sep=;\"\n" + semicolons};
  all.push_back(replaced(semicolons, ";", "\t"));
  all.push_back(replaced(text, "\n", ",,\n") + ",,,,\n,,,,\n");
  all.push_back(replaced(text, "\n", "\n\n  \n"));
  for (const std::string end : {"\r\n", "\r"}) {
    for (const std::string& one : std::vector(all)) all.push_back(replaced(one, "\n", end));
  }
  for (const bool big : {false, true}) {
    for (const std::string& one : std::vector(all)) {
      if (!one.starts_with('\xEF')) all.push_back(utf16(std::u16string(one.begin(), one.end()), big));
      if (all.size() > 60) break;
    }
  }
  for (const std::string& one : all) {
    const auto table = parse_csv(one, "t.csv", required);
    ASSERT_TRUE(table) << table.error().message << "\n" << one;
    ASSERT_EQ(table->row.size(), 2U) << one;
    EXPECT_EQ(cell(*table, 0, "name"), "hip joint");
    EXPECT_EQ(number(number_cell(*table, 0, "x")), -82.5) << one;
    EXPECT_EQ(cell(*table, 1, "name"), "knee, right");
    EXPECT_EQ(number(number_cell(*table, 1, "x")), 100.0);
    EXPECT_EQ(cell(*table, 1, "unit"), "mm");
  }
}

TEST(CsvTable, QuotedCellsHaveSeparatorsQuotesAndLineEnds) {
  const auto table =
      parse_csv("name,x,unit\r\n\"a \"\"b\"\",\r\nc\",1,mm\r\n5\" pipe,2,\"in\"\r\n,,\r\nlast,3,m", "t.csv", required);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(cell(*table, 0, "name"), "a \"b\",\nc");
  EXPECT_EQ(cell(*table, 1, "name"), "5\" pipe");
  EXPECT_EQ(cell(*table, 1, "unit"), "in");
  EXPECT_EQ(table->line, (std::vector<std::size_t>{2, 4, 6}));
}

TEST(CsvTable, CommasOfNumbersBecomePointsOnlyBetweenOtherSeparators) {
  const auto table = parse_csv("name;x;unit\n1,5 m/s;+0,25;1,2,3\n1.234,5;,5;a,5\n", "t.csv", required);
  ASSERT_TRUE(table) << table.error().message;
  const auto numbers = [&](std::size_t row) {
    return std::vector{number_cell(*table, row, "name"), number_cell(*table, row, "x"),
                       number_cell(*table, row, "unit")};
  };
  EXPECT_EQ(numbers(0), (std::vector<std::string>{"1.5 m/s", "+0.25", "1,2,3"}));
  EXPECT_EQ(numbers(1), (std::vector<std::string>{"1.234,5", ".5", "a,5"}));
  const auto commas = parse_csv("name,x,unit\n\"1,5\",1,m\n", "t.csv", required);
  EXPECT_EQ(number_cell(*commas, 0, "name"), "1,5");
}

TEST(CsvTable, CellsOfTextKeepTheirCommas) {
  for (const std::string separator : {";", "\t"}) {
    for (const std::string quote : {"", "\""}) {
      const auto table = parse_csv(
          replaced("name;x;unit\n" + quote + "1,5 soleus.obj" + quote + ";1,5;m\n", ";", separator), "t.csv", required);
      ASSERT_TRUE(table) << table.error().message;
      EXPECT_EQ(cell(*table, 0, "name"), "1,5 soleus.obj");
      EXPECT_EQ(number(number_cell(*table, 0, "x")), 1.5);
    }
  }
}

TEST(CsvTable, SeparatorIsFoundBesideLineEndsInQuotes) {
  for (const std::string separator : {",", ";", "\t"}) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      const std::string text = "name;x;unit;\"a note\n, or more\"\nhip;1;m;\n";
      const auto table = parse_csv(replaced(replaced(text, ";", separator), "\n", end), "t.csv", required);
      ASSERT_TRUE(table) << table.error().message;
      EXPECT_EQ(table->header, (std::vector<std::string>{"name", "x", "unit", "a note\n, or more"}));
      EXPECT_EQ(table->line[0], 3U);
    }
  }
}

TEST(CsvTable, ZerosAndCtrlZBehindTheLastLineAreIgnored) {
  for (const std::string& tail : {std::string("\x1A"), std::string("\n\x1A"), std::string("\n\0\0\0", 4)}) {
    const auto table = parse_csv("name,x,unit\nhip,1,m" + tail, "t.csv", required);
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_EQ(table->row, (std::vector<std::vector<std::string>>{{"hip", "1", "m"}}));
  }
}

TEST(CsvTable, NonAsciiNamesComeFromUtf16) {
  const auto table = parse_csv(utf16(u"name;x;unit\nMüskel \U0001F9B5;1;m\n\xD800;1;m", true), "t.csv", required);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->row[0][0], "M\xC3\xBCskel \xF0\x9F\xA6\xB5");
  EXPECT_EQ(table->row[1][0], "\xEF\xBF\xBD");
}

TEST(CsvTable, OtherFilesAreRefusedByWhatTheyAre) {
  const auto refused = [](const std::string& bytes, const std::string& piece) {
    EXPECT_TRUE(is_refused(parse_csv(bytes, "t.csv", required), "t.csv", piece)) << bytes;
  };
  refused(std::string("PK\x03\x04\0\0", 6), "spreadsheet's own format; save it as CSV");
  refused(std::string("\xD0\xCF\x11\xE0\xA1", 5), "spreadsheet's own format");
  refused(std::string("n\0a\0m\0e\0", 8), "zero bytes");
  for (const std::string bad :
       {"M\xFCskel", "\xE4", "\xC3", "\xC3(", "\x80", "\xC0\x80", "\xF5\x80\x80\x80", "\xE2\x82"})
    refused("name,x,unit\r\n\"M\xC3\xBCskel\r\n\",1,m\r\n" + bad + ",1,m\r\n", "t.csv line 4: not UTF-8");
  refused("", "no rows");
  refused("name;x\n1;2\n", "no column 'unit'");
  refused("name,x,unit\na,1,5,m\n", "t.csv line 2: 4 cells where the header has 3; add or remove commas");
  refused("name;x;unit\na;1\n", "add or remove semicolons");
  refused("name,x,unit\na,1,m\n\n\"b,1,m\nc,1,m\n", "t.csv line 4: a quote is never closed");
}

}  // namespace mobil::csv_table_test
