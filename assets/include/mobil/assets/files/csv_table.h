#pragma once
// A small CSV file read whole, its cells found by the column's name.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Header and rows, every row as wide as the header. `path`: the file, or what else messages are to call it; `line[r]`:
/// the row's line in it, counted from 1.
struct CsvTable {
  std::string path;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> row;
  std::vector<std::size_t> line;
};

/// Reads commas, double quotes (a quote inside is doubled; no line break inside), LF or CRLF, an optional UTF-8 mark;
/// empty lines are passed over. Fails for a table without rows, a missing column of `required`, an open quote, a row
/// that is not as wide as the header.
Result<CsvTable> parse_csv(std::string_view text, std::string_view name, std::span<const std::string_view> required);

/// The same from a file; also fails where it cannot be read.
Result<CsvTable> read_csv(const std::string& path, std::span<const std::string_view> required);

/// Where a column stands, if it is there.
std::optional<std::size_t> column(const CsvTable& table, std::string_view name);

/// The cell, or nothing where the column is absent.
std::string_view cell(const CsvTable& table, std::size_t row, std::string_view name);

/// The whole cell as a finite number, with or without a sign.
std::optional<double> number(std::string_view text);

}  // namespace mobil::inline v0_3
