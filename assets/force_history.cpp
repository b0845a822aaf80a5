#include "assets/force_history.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

namespace mobil {
namespace {

constexpr std::string_view header = "time_s,force_x_n,force_y_n,force_z_n";

std::string_view trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> number(std::string_view field) {
  field = trimmed(field);
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::array<double, 4>> four_numbers(std::string_view line) {
  std::array<double, 4> values{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto comma = line.find(',');
    if ((comma == std::string_view::npos) != (i == 3)) return std::nullopt;
    const auto value = number(line.substr(0, comma));
    if (!value) return std::nullopt;
    values[i] = *value;
    line.remove_prefix(i == 3 ? line.size() : comma + 1);
  }
  return values;
}

}  // namespace

Vec3<double> force_at(const ForceHistory& history, double time_s) {
  const auto& row = history.row;
  if (row.empty() || time_s < row.front().time_s) return {0, 0, 0};
  std::size_t next = 1;  // first row after this moment
  while (next < row.size() && row[next].time_s <= time_s) ++next;
  const auto& a = row[next - 1];
  if (next == row.size()) return a.force_n;
  const auto& b = row[next];
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  const auto mix = [s](double p, double q) { return p + s * (q - p); };
  return {mix(a.force_n.x, b.force_n.x), mix(a.force_n.y, b.force_n.y), mix(a.force_n.z, b.force_n.z)};
}

Result<ForceHistory> parse_force_history(std::string_view text, std::string_view name) {
  ForceHistory history;
  std::size_t line_number = 0;
  bool headed = false;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const auto line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    if (line.empty()) continue;
    if (!headed) {
      if (line != header) {
        return fail(
            fmt::format("{}:{}: the header must be '{}', not '{}'", name, line_number, header, line.substr(0, 60)));
      }
      headed = true;
      continue;
    }
    const auto values = four_numbers(line);
    if (!values) {
      return fail(
          fmt::format("{}:{}: '{}' must be four finite numbers: {}", name, line_number, line.substr(0, 60), header));
    }
    const auto [time, x, y, z] = *values;
    if (!history.row.empty() && time < history.row.back().time_s) {
      return fail(fmt::format("{}:{}: time {} s comes before {} s in the row above; sort the rows by time", name,
                              line_number, time, history.row.back().time_s));
    }
    history.row.push_back({time, {x, y, z}});
  }
  if (history.row.empty()) return fail(fmt::format("{}: no rows; write '{}' and at least one row", name, header));
  return history;
}

Result<ForceHistory> read_force_history(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, ignored)) {
    return fail(fmt::format("{}: cannot be read; name a CSV file with the columns {}", path.string(), header));
  }
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) return fail(fmt::format("{}: cannot be read to its end", path.string()));
  return parse_force_history(text, path.string());
}

}  // namespace mobil
