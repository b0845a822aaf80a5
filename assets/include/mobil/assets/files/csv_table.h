#pragma once
// A small CSV file, read completely, with cells found by column name.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Header and rows, every row as wide as the header. `path` is the file, or its name in messages. `line[r]` is the
/// row's line in it, counted from 1.
struct CsvTable {
  std::string path;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> row;
  std::vector<std::size_t> line;
  bool decimal_comma = false;  // numbers can have one
};

/// Reads cells between commas, semicolons or tabs, whichever give the header its columns; between the latter two,
/// numbers can have a decimal comma. Cells in double quotes can have separators, line ends and doubled quotes inside.
/// Reads UTF-8, UTF-16 with a mark, and lines that end with LF, CRLF or CR; skips rows without any text. Fails on other
/// bytes, a table without rows, a missing column of `required`, an open quote, or a row that is not as wide as the
/// header.
Result<CsvTable> parse_csv(std::string_view bytes, std::string_view name, std::span<const std::string_view> required);

/// Reads a table from a file. Also fails if the file cannot be read.
Result<CsvTable> read_csv(const std::string& path, std::span<const std::string_view> required);

/// Returns the index of a column, or nothing.
std::optional<std::size_t> column(const CsvTable& table, std::string_view name);

/// Returns the cell, or nothing if the column is absent.
std::string_view cell(const CsvTable& table, std::size_t row, std::string_view name);

/// Returns the cell with a point for the decimal comma that the number at its beginning can have.
std::string number_cell(const CsvTable& table, std::size_t row, std::string_view name);

/// Returns the whole text as a finite number, with or without a sign, or nothing.
std::optional<double> number(std::string_view text);

}  // namespace mobil::inline v0_3
