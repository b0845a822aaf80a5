#include "demo/lab/paper/paper_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace mobil {
namespace {

constexpr std::string_view between_columns = "  ";

/// Counts letters, not bytes.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string space(width - std::min(width, letters(text)), ' ');
  return to_the_right ? space + text : text + space;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

void trim_end(std::string& text) {
  while (text.ends_with(' ')) text.pop_back();
}

/// Returns a number as text; empty without one.
std::string cell_text(const PaperTable& table, const PaperTable::Row& row, std::size_t column) {
  const double v = column < row.value.size() ? row.value[column] : NAN;
  return std::isfinite(v) ? fmt::format("{:.{}f}", v, table.column[column].decimals) : "";
}

using Lines = std::vector<std::vector<std::string>>;

/// Aligns cells, with all lines as long as the first: the first column to the left, the others to the right.
std::string aligned(const Lines& cells) {
  std::string text;
  std::vector<std::size_t> width(cells.front().size(), 0);
  for (const auto& line : cells) {
    for (std::size_t c = 0; c < width.size(); ++c) width[c] = std::max(width[c], letters(line[c]));
  }
  for (const auto& line : cells) {
    for (std::size_t c = 0; c < width.size(); ++c) {
      text += padded(line[c], width[c], c > 0);
      text += between_columns;
    }
    trim_end(text);
    text += '\n';
  }
  return text;
}

/// Returns a line of cells for each line of the heads, which are aligned at the bottom. The first column's is `label`.
Lines head_lines(const std::string& label, const std::vector<std::string>& heads) {
  std::size_t most = 1;
  for (const auto& head : heads) most = std::max(most, lines_of(head).size());
  Lines lines(most, std::vector<std::string>(heads.size() + 1));
  lines.back()[0] = label;
  for (std::size_t c = 0; c < heads.size(); ++c) {
    const auto head = lines_of(heads[c]);
    for (std::size_t i = 0; i < head.size(); ++i) lines[most - head.size() + i][c + 1] = head[i];
  }
  return lines;
}

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

}  // namespace

std::string table_text(const PaperTable& table) {
  std::vector<std::string> heads;
  for (const auto& column : table.column) heads.push_back(column.head);
  Lines lines = head_lines(table.label_name, heads);
  for (const auto& row : table.row) {
    auto& line = lines.emplace_back(1, in_one_line(row.label));
    for (std::size_t c = 0; c < table.column.size(); ++c) line.push_back(cell_text(table, row, c));
  }
  return aligned(lines);
}

std::string turned_table_text(const PaperTable& table) {
  std::vector<std::string> heads;
  for (const auto& row : table.row) heads.push_back(row.label);
  Lines lines = head_lines(table.label_name, heads);
  for (std::size_t c = 0; c < table.column.size(); ++c) {
    auto& line = lines.emplace_back(1, in_one_line(table.column[c].head));
    for (const auto& row : table.row) line.push_back(cell_text(table, row, c));
  }
  return aligned(lines);
}

std::string table_csv(const PaperTable& table) {
  std::string text = table.label_name;
  for (const auto& column : table.column) text += "," + column.name;
  text += '\n';
  for (const auto& row : table.row) {
    text += in_one_line(row.label);
    for (std::size_t c = 0; c < table.column.size(); ++c) {
      const double v = c < row.value.size() ? row.value[c] : NAN;
      text += std::isfinite(v) ? fmt::format(",{:.6g}", v) : ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace mobil
