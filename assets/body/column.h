#pragma once
// Distribution of the column's bending between pelvis and chest.

#include <array>
#include <cstddef>

#include <mobil/components/segments.h>

namespace mobil::inline v0_3 {

/// Anterior tilt of the pelvis of an upright person, as gait laboratories measure it (front and back of the iliac
/// crest), rad. It is the tilt of the anatomical position, from which the column is turned.
inline constexpr double neutral_tilt = 11.5 * 3.14159265358979324 / 180;

/// Share of the rotation from the pelvis' attitude to the chest's that each vertebra has completed, from the fifth
/// lumbar to the first thoracic. The five lumbar ones complete two thirds, the rest is spread evenly.
using ColumnParts = std::array<double, index(Segment::T1) - index(Segment::L5) + 1>;
constexpr ColumnParts column_parts() {
  constexpr double lumbar = 5, all = 17, lumbar_part = 2.0 / 3;
  ColumnParts parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto above = static_cast<double>(i + 1);
    parts[i] = above <= lumbar ? lumbar_part * above / lumbar
                               : lumbar_part + (1 - lumbar_part) * (above - lumbar) / (all - lumbar);
  }
  return parts;
}

}  // namespace mobil::inline v0_3
