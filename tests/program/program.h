#pragma once
// Runs the `mobil` program and reads its output.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/files/temporary_folder.h"

namespace mobil {

/// True if built with a sanitizer, under which measurements take minutes and have no meaning.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

struct Ran {
  int status = -1;
  std::string out, err;
};

/// Runs a command line of the shell in the folder `in`.
inline Ran run_shell(const std::string& command, const std::filesystem::path& in) {
  const TemporaryFolder streams;
  const int status = std::system(fmt::format("cd '{}' && {} >'{}' 2>'{}' </dev/null", in.string(), command,
                                             (streams.path / "out").string(), (streams.path / "err").string())
                                     .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(streams.path / "out"),
          read_bytes(streams.path / "err")};
}

/// Runs `mobil` with those arguments, as a shell reads them.
inline Ran run_mobil(const std::string& arguments, const std::filesystem::path& in) {
  return run_shell("'" MOBIL_PROGRAM "' " + arguments, in);
}

/// Expects `mobil COMMAND` to refuse each set of arguments with status 2 and one line that contains all its pieces, and
/// to leave the folder `in` unchanged.
inline void expect_refused(const std::string& command, const std::map<std::string, std::vector<std::string>>& refused,
                           const std::filesystem::path& in) {
  const auto entries = [&in] { return std::distance(std::filesystem::directory_iterator(in), {}); };
  const auto before = entries();
  for (const auto& [arguments, pieces] : refused) {
    const Ran ran = run_mobil(command + " " + arguments, in);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << arguments << ": " << ran.err;
    EXPECT_TRUE(ran.err.starts_with("mobil " + command + ": ")) << ran.err;
    EXPECT_EQ(ran.out, "") << arguments;
    for (const auto& piece : pieces) {
      EXPECT_NE(ran.err.find(piece), std::string::npos) << "no '" << piece << "' in: " << ran.err;
    }
  }
  EXPECT_EQ(entries(), before);
}

/// A CSV file with a header, by column.
class Csv {
 public:
  explicit Csv(const std::filesystem::path& file) {
    std::istringstream lines(read_bytes(file));
    std::string line;
    std::getline(lines, line);
    columns = cells(line);
    while (std::getline(lines, line)) {
      auto row = cells(line);
      if (row.size() != columns.size()) throw std::runtime_error("another number of cells: " + line);
      rows.push_back(std::move(row));
    }
  }

  const std::string& text(std::size_t row, const std::string& column) const { return rows[row][number_of(column)]; }
  /// Returns a cell's number; NaN if it is empty.
  double number(std::size_t row, const std::string& column) const {
    const std::string& cell = text(row, column);
    return cell.empty() ? std::nan("") : std::stod(cell);
  }
  bool has(const std::string& column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }

  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

 private:
  static std::vector<std::string> cells(const std::string& line) {
    std::vector<std::string> cut(1);
    for (const char c : line) {
      if (c == ',') {
        cut.emplace_back();
      } else {
        cut.back() += c;
      }
    }
    return cut;
  }
  std::size_t number_of(const std::string& column) const {
    const auto at = std::find(columns.begin(), columns.end(), column);
    if (at == columns.end()) throw std::runtime_error("no column " + column);
    return static_cast<std::size_t>(at - columns.begin());
  }
};

}  // namespace mobil
