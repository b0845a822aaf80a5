#pragma once
// A small CSV file read whole, its cells found by the column's name.

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/error.h"

namespace mobil {

/// Header and rows, every row as wide as the header. `line[r]` is the row's line in the file, counted from 1.
struct CsvTable {
  std::string path;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> row;
  std::vector<std::size_t> line;
};

/// Reads commas, double quotes (a quote inside is doubled; no line break inside), LF or CRLF, an optional UTF-8 mark;
/// empty lines are passed over. Fails for a missing or empty file, a missing column of `required`, an open quote, a row
/// that is not as wide as the header.
Result<CsvTable> read_csv(const std::string& path, std::initializer_list<std::string_view> required);

/// Where a column stands, if it is there.
std::optional<std::size_t> column(const CsvTable& table, std::string_view name);

/// The cell, or nothing where the column is absent.
std::string_view cell(const CsvTable& table, std::size_t row, std::string_view name);

/// The whole cell as a finite number.
std::optional<double> number(std::string_view text);

}  // namespace mobil
