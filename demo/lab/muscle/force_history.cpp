#include "demo/lab/muscle/force_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include <mobil/assets/files/csv_table.h>

namespace mobil {
namespace {

constexpr std::array<std::string_view, 4> force_columns = {"time_s", "force_x_n", "force_y_n", "force_z_n"};

Result<ForceHistory> from_table(const CsvTable& table) {
  ForceHistory history;
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    std::array<double, 4> value{};
    for (std::size_t c = 0; c < value.size(); ++c) {
      const auto text = number_cell(table, r, force_columns[c]);
      const auto read = number(text);
      if (!read) {
        return fail(fmt::format("{} line {}: {} '{}' is not a finite number; write one", table.path, table.line[r],
                                force_columns[c], text.substr(0, 60)));
      }
      value[c] = *read;
    }
    const auto [time, x, y, z] = value;
    if (!history.row.empty() && time < history.row.back().time_s) {
      return fail(fmt::format("{} line {}: time {} s comes before {} s in the row above; sort the rows by time",
                              table.path, table.line[r], time, history.row.back().time_s));
    }
    history.row.push_back({time, {x, y, z}});
  }
  return history;
}

}  // namespace

Vec3<double> force_at(const ForceHistory& history, double time_s) {
  const auto& row = history.row;
  const auto after = std::upper_bound(row.begin(), row.end(), time_s,
                                      [](double t, const ForceHistory::Row& r) { return t < r.time_s; });
  if (after == row.begin()) return {0, 0, 0};
  const auto& a = *std::prev(after);
  if (after == row.end()) return a.force_n;
  const auto& b = *after;
  const double s = (time_s - a.time_s) / (b.time_s - a.time_s);
  const auto mix = [s](double p, double q) { return p + s * (q - p); };
  return {mix(a.force_n.x, b.force_n.x), mix(a.force_n.y, b.force_n.y), mix(a.force_n.z, b.force_n.z)};
}

Result<ForceHistory> parse_force_history(std::string_view text, std::string_view name) {
  return parse_csv(text, name, force_columns).and_then(from_table);
}

Result<ForceHistory> read_force_history(const std::filesystem::path& path) {
  return read_csv(path.string(), force_columns).and_then(from_table);
}

}  // namespace mobil
