#pragma once
// Numbers (of vertices, of triangles) sorted by their cell of space, to find those near a point.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <unordered_map>
#include <vector>

#include <mobil/components/lanes.h>
#include "engine/row_hash.h"

namespace mobil::inline v0_3 {

class SpaceCells {
 public:
  /// Creates cubes with edges of that length.
  explicit SpaceCells(double cell_m) : cell_m_(cell_m) {}

  double cell_m() const { return cell_m_; }
  void add(std::uint32_t number, const Vec3<double>& at) { cells_[cell(at)].push_back(number); }
  /// Calls `f(number)` for all in the cells from `first` to `last` cells away from that of `at`, by the maximum of x, y
  /// and z.
  template <class F>
  void near(const Vec3<double>& at, std::int32_t first, std::int32_t last, const F& f) const {
    const Cell c = cell(at);
    for (std::int32_t x = -last; x <= last; ++x)
      for (std::int32_t y = -last; y <= last; ++y)
        for (std::int32_t z = -last; z <= last; ++z) {
          if (std::max({std::abs(x), std::abs(y), std::abs(z)}) < first) continue;
          const auto found = cells_.find({c[0] + x, c[1] + y, c[2] + z});
          if (found == cells_.end()) continue;
          for (const std::uint32_t number : found->second) f(number);
        }
  }
  /// Calls `f(number)` for all.
  template <class F>
  void each(const F& f) const {
    for (const auto& [where, numbers] : cells_)
      for (const std::uint32_t number : numbers) f(number);
  }

 private:
  using Cell = std::array<std::int32_t, 3>;
  Cell cell(const Vec3<double>& at) const {
    const auto of = [&](double m) { return static_cast<std::int32_t>(std::floor(m / cell_m_)); };
    return {of(at.x), of(at.y), of(at.z)};
  }
  struct Hash {
    std::size_t operator()(const Cell& c) const { return hash_bytes(c.data(), sizeof c); }
  };

  double cell_m_;
  std::unordered_map<Cell, std::vector<std::uint32_t>, Hash> cells_;
};

}  // namespace mobil::inline v0_3
