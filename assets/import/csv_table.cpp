#include "assets/import/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

namespace mobil {
namespace {

/// Nothing for an open quote.
std::optional<std::vector<std::string>> split(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (quoted) return std::nullopt;
  return cells;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::optional<std::size_t> column(const CsvTable& table, std::string_view name) {
  const auto found = std::find(table.header.begin(), table.header.end(), name);
  if (found == table.header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - table.header.begin());
}

std::string_view cell(const CsvTable& table, std::size_t row, std::string_view name) {
  const auto at = column(table, name);
  return at ? std::string_view(table.row[row][*at]) : std::string_view();
}

std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<CsvTable> read_csv(const std::string& path, std::initializer_list<std::string_view> required) {
  std::ifstream in(path);
  if (!in) return fail(fmt::format("{}: cannot be read; put the file there or name another folder", path));
  CsvTable table;
  table.path = path;
  std::size_t number_of_line = 0;
  for (std::string text; std::getline(in, text);) {
    ++number_of_line;
    std::string_view line = text;
    if (number_of_line == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (trimmed(line).empty()) continue;
    auto cells = split(line);
    if (!cells) return fail(fmt::format("{} line {}: a quote is never closed; close it", path, number_of_line));
    for (auto& text_cell : *cells) text_cell = std::string(trimmed(text_cell));
    if (table.header.empty()) {
      table.header = std::move(*cells);
      continue;
    }
    if (cells->size() != table.header.size()) {
      return fail(fmt::format("{} line {}: {} cells where the header has {}; add or remove commas, or quote the cell",
                              path, number_of_line, cells->size(), table.header.size()));
    }
    table.row.push_back(std::move(*cells));
    table.line.push_back(number_of_line);
  }
  for (const auto name : required) {
    if (!column(table, name)) {
      return fail(fmt::format("{}: no column '{}'; the header needs {}", path, name, fmt::join(required, ", ")));
    }
  }
  if (table.row.empty()) return fail(fmt::format("{}: no rows below the header; write at least one", path));
  return table;
}

}  // namespace mobil
