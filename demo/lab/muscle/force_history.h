#pragma once
// A load over time as a table, as `mobil muscle --load` reads it.

#include <filesystem>
#include <string_view>
#include <vector>

#include <mobil/components/lanes.h>
#include <mobil/engine/error.h>

namespace mobil {

/// Total force on a face, N, at ascending times, s. Two rows of the same time are a jump.
struct ForceHistory {
  struct Row {
    double time_s;
    Vec3<double> force_n;
  };
  std::vector<Row> row;
};

/// Returns the force: linear between rows, zero before the first, held after the last. At a jump, the later row's.
Vec3<double> force_at(const ForceHistory& history, double time_s);

/// Reads CSV text with the columns time_s, force_x_n, force_y_n, force_z_n; `name` is for messages. Fails, naming the
/// line, on a missing column, a row that is not finite numbers, a moment before the row above it, or no rows.
Result<ForceHistory> parse_force_history(std::string_view text, std::string_view name);

/// Reads a file instead; also fails if it cannot be read.
Result<ForceHistory> read_force_history(const std::filesystem::path& path);

}  // namespace mobil
