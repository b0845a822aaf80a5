#include "demo/paper_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace mobil {
namespace {

constexpr std::string_view between_columns = "  ";

/// Letters, not bytes.
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

/// As people read it; empty where it is none.
std::string cell_text(const PaperTable& table, const PaperTable::Row& row, std::size_t column) {
  const double v = column < row.value.size() ? row.value[column] : NAN;
  return std::isfinite(v) ? fmt::format("{:.{}f}", v, table.column[column].decimals) : "";
}

using Cells = std::vector<std::vector<std::string>>;

/// All lines as long as the first; the first column to the left, the others to the right.
std::string aligned(const Cells& cells) {
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

}  // namespace

std::string table_text(const PaperTable& table) {
  const std::size_t columns = table.column.size();
  std::vector<std::vector<std::string>> head;
  std::size_t head_lines = 1;
  for (const auto& column : table.column) {
    head.push_back(lines_of(column.head));
    head_lines = std::max(head_lines, head.back().size());
  }
  Cells cells(head_lines, std::vector<std::string>(columns + 1));  // the heads stand on the table
  cells.back()[0] = table.label_name;
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t i = 0; i < head[c].size(); ++i) cells[head_lines - head[c].size() + i][c + 1] = head[c][i];
  }
  for (const auto& row : table.row) {
    auto& line = cells.emplace_back(1, row.label);
    for (std::size_t c = 0; c < columns; ++c) line.push_back(cell_text(table, row, c));
  }
  return aligned(cells);
}

std::string turned_table_text(const PaperTable& table) {
  Cells cells{{table.label_name}};
  for (const auto& row : table.row) cells[0].push_back(row.label);
  for (std::size_t c = 0; c < table.column.size(); ++c) {
    std::string head = table.column[c].head;
    std::ranges::replace(head, '\n', ' ');
    auto& line = cells.emplace_back(1, std::move(head));
    for (const auto& row : table.row) line.push_back(cell_text(table, row, c));
  }
  return aligned(cells);
}

std::string table_csv(const PaperTable& table) {
  std::string text = table.label_name;
  for (const auto& column : table.column) text += "," + column.name;
  text += '\n';
  for (const auto& row : table.row) {
    text += row.label;
    for (std::size_t c = 0; c < table.column.size(); ++c) {
      const double v = c < row.value.size() ? row.value[c] : NAN;
      text += std::isfinite(v) ? fmt::format(",{:.6g}", v) : ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace mobil
