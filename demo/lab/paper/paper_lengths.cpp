#include "demo/lab/paper/paper_lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include <mobil/assets/files/csv_table.h>
#include "demo/lab/compare/reference_tables.h"

namespace mobil {
namespace {

constexpr std::string_view lengths_file = "muscle_lengths.csv";
constexpr std::array<std::string_view, 5> length_names = {"hamstrings", "rectus_femoris", "gastrocnemius", "soleus",
                                                          "tibialis_anterior"};
constexpr std::array<std::string_view, 2> required = {"curve", "percent_gait"};

}  // namespace

Result<std::vector<PublishedLength>> read_published_lengths(std::string_view walk) {
  const auto tables = reference_tables();
  const auto found = std::ranges::find(tables, lengths_file, &ReferenceTable::name);
  if (found == tables.end())
    return fail(fmt::format("the program was built without assets/reference/{}", lengths_file));
  const auto table = parse_csv(found->text, lengths_file, required);
  if (!table) return tl::unexpected(table.error());
  std::vector<PublishedLength> lengths;
  for (const std::string_view name : length_names) {
    PublishedLength length{std::string(name), {}};
    std::size_t points = 0;
    for (std::size_t r = 0; r < table->row.size(); ++r) {
      if (cell(*table, r, "curve") != walk) continue;
      const auto percent = number(cell(*table, r, "percent_gait"));
      const auto mean = number(cell(*table, r, name));
      if (!percent || !mean || points >= cycle_points || *percent != 2.0 * static_cast<double>(points)) {
        return fail(fmt::format("{} line {}: {} needs every 2 % of the cycle and a number for {}", lengths_file,
                                table->line[r], walk, name));
      }
      length.curve.mean[points] = *mean;
      length.curve.sd[points] = number(cell(*table, r, fmt::format("{}_sd", name))).value_or(0);
      ++points;
    }
    if (points != cycle_points)
      return fail(fmt::format("{}: {} of {} rows of {}", lengths_file, points, cycle_points, walk));
    lengths.push_back(std::move(length));
  }
  return lengths;
}

}  // namespace mobil
