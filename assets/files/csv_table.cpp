#include <mobil/assets/files/csv_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace mobil::inline v0_3 {
namespace {

/// Returns "a, b, c".
std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// Returns nothing for an open quote.
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
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
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
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<CsvTable> parse_csv(std::string_view text, std::string_view name, std::span<const std::string_view> required) {
  CsvTable table;
  table.path = name;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::size_t header_line = 0;
  for (std::size_t number_of_line = 1; !text.empty(); ++number_of_line) {
    const auto end = text.find('\n');
    const auto line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty()) continue;
    auto cells = split(line);
    if (!cells) return fail(fmt::format("{} line {}: a quote is never closed; close it", name, number_of_line));
    for (auto& text_cell : *cells) text_cell = std::string(trimmed(text_cell));
    if (table.header.empty()) {
      table.header = std::move(*cells);
      header_line = number_of_line;
      continue;
    }
    if (cells->size() != table.header.size()) {
      return fail(fmt::format("{} line {}: {} cells where the header has {}; add or remove commas, or quote the cell",
                              name, number_of_line, cells->size(), table.header.size()));
    }
    table.row.push_back(std::move(*cells));
    table.line.push_back(number_of_line);
  }
  for (const auto column_name : required) {
    if (table.header.empty() || column(table, column_name)) continue;
    return fail(fmt::format("{} line {}: no column '{}'; the header needs {}", name, header_line, column_name,
                            listed(required)));
  }
  if (table.row.empty()) {
    return fail(fmt::format("{}: no rows; write a header with {} and at least one row", name, listed(required)));
  }
  return table;
}

Result<CsvTable> read_csv(const std::string& path, std::span<const std::string_view> required) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, ignored)) {
    return fail(fmt::format("{}: cannot be read; put a CSV file there, or name another, with the columns {}", path,
                            listed(required)));
  }
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return parse_csv(text, path, required);
}

}  // namespace mobil::inline v0_3
