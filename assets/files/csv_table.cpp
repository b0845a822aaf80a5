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

#include "assets/files/csv_text.h"

namespace mobil::inline v0_3 {
namespace {

/// Returns "a, b, c".
std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The cells of a record, and its number of lines.
struct Record {
  std::vector<std::string> cells;
  std::size_t lines = 1;
};

/// Takes the next record from the text. A cell that begins with a quote ends with one, and can have separators, line
/// ends and doubled quotes inside. Returns nothing for an open quote.
std::optional<Record> take_record(std::string_view& text, char separator) {
  Record record;
  record.cells.emplace_back();
  bool quoted = false;
  std::size_t i = 0;
  for (; i < text.size() && (quoted || text[i] != '\n'); ++i) {
    const char c = text[i];
    std::string& own = record.cells.back();
    record.lines += c == '\n' ? 1 : 0;
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      own += text[++i];
    } else if (c == '"' && (quoted || trimmed(own).empty())) {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      record.cells.emplace_back();
    } else {
      own += c;
    }
  }
  text.remove_prefix(std::min(i + 1, text.size()));
  if (quoted) return std::nullopt;
  for (auto& own : record.cells) own = std::string(trimmed(own));
  return record;
}

bool all_empty(std::span<const std::string> cells) {
  return std::ranges::all_of(cells, [](const std::string& own) { return own.empty(); });
}

/// Returns the separator with which the text's header has the required columns, or else most cells.
char separator_of(std::string_view whole, std::span<const std::string_view> required) {
  char best = ',';
  std::size_t most = 0;
  for (const char separator : {',', ';', '\t'}) {
    std::string_view text = whole;
    const auto record = take_record(text, separator);
    if (!record) continue;
    const bool complete = std::ranges::all_of(required, [&](std::string_view wanted) {
      return std::ranges::find(record->cells, wanted) != record->cells.end();
    });
    const std::size_t cells = record->cells.size() + (complete && !required.empty() ? whole.size() : 0);
    if (cells > most) {
      most = cells;
      best = separator;
    }
  }
  return best;
}

/// Returns the text with a point for the comma of a number at its beginning.
std::string with_point(std::string text) {
  const std::size_t first = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::size_t comma = text.find_first_not_of("0123456789", first);
  if (comma == std::string::npos || text[comma] != ',') return text;
  const std::size_t end = text.find_first_not_of("0123456789", comma + 1);
  const bool digits = end == std::string::npos ? text.size() > comma + 1 : end > comma + 1;
  if (digits && (end == std::string::npos || (text[end] != ',' && text[end] != '.'))) text[comma] = '.';
  return text;
}

/// Takes "sep=;" away, with which a spreadsheet's table can begin, also in quotes.
std::optional<char> take_separator(std::string_view& text) {
  auto line = trimmed(text.substr(0, text.find('\n')));
  if (line.size() > 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  if ((!line.starts_with("sep=") && !line.starts_with("SEP=")) || line.size() > 5) return std::nullopt;
  text.remove_prefix(std::min(text.find('\n'), text.size()));
  return line.size() == 5 ? line[4] : '\t';
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

std::string number_cell(const CsvTable& table, std::size_t row, std::string_view name) {
  std::string text(cell(table, row, name));
  return table.decimal_comma ? with_point(std::move(text)) : text;
}

std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

Result<CsvTable> parse_csv(std::string_view bytes, std::string_view name, std::span<const std::string_view> required) {
  CsvTable table;
  table.path = name;
  const auto decoded = csv_text(bytes, name);
  if (!decoded) return tl::unexpected(decoded.error());
  std::string_view text = *decoded;
  auto separator = take_separator(text);
  std::size_t header_line = 0;
  for (std::size_t line = 1; !text.empty();) {
    const std::size_t own_line = line;
    if (!separator && !trimmed(text.substr(0, text.find('\n'))).empty()) separator = separator_of(text, required);
    auto record = take_record(text, separator.value_or(','));
    if (!record) return fail(fmt::format("{} line {}: a quote is never closed; close it", name, own_line));
    line += record->lines;
    auto& cells = record->cells;
    if (all_empty(cells)) continue;  // a spreadsheet's empty row
    if (table.header.empty()) {
      while (cells.back().empty()) cells.pop_back();
      table.header = std::move(cells);
      header_line = own_line;
      continue;
    }
    const std::size_t width = table.header.size();
    if (cells.size() > width && all_empty(std::span(cells).subspan(width))) cells.resize(width);
    if (cells.size() != width) {
      return fail(fmt::format("{} line {}: {} cells where the header has {}; add or remove {}, or quote the cell", name,
                              own_line, cells.size(), width,
                              *separator == ','   ? "commas (decimals have a point)"
                              : *separator == ';' ? "semicolons"
                                                  : "tabs"));
    }
    table.row.push_back(std::move(cells));
    table.line.push_back(own_line);
  }
  table.decimal_comma = separator.value_or(',') != ',';
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
