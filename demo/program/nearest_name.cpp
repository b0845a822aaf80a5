#include "demo/program/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace mobil {
namespace {

constexpr std::size_t shortest_part = 3;  // letters; shorter parts occur in too many names

/// Returns the Levenshtein distance: letters to change, insert or delete.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string suggestion(std::string_view given, std::span<const std::string> known) {
  const std::string* nearest = nullptr;
  std::pair<bool, std::size_t> best;
  for (const auto& name : known) {
    const std::size_t needed = edits(given, name);
    const bool part = given.size() >= shortest_part && name.find(given) != std::string::npos;
    const std::pair cost{!part, needed};  // names that contain it come first
    if ((!part && 2 * needed > given.size()) || (nearest != nullptr && cost >= best)) continue;
    nearest = &name;
    best = cost;
  }
  return nearest == nullptr ? std::string() : fmt::format(" (did you mean {}?)", *nearest);
}

}  // namespace mobil
