#pragma once
// Conversion between one row and a block, for computations on single entities outside of the tick.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include <mobil/components/lanes.h>

namespace mobil::inline v0_3 {

/// Copies one row into all sixteen lanes.
template <template <class> class C>
C<Lanes<float>> broadcast(const C<float>& row) {
  C<Lanes<float>> block;
  constexpr std::size_t words = sizeof(row) / 4;
  std::uint32_t word[words];
  std::memcpy(word, &row, sizeof(row));
  auto* out = reinterpret_cast<std::byte*>(&block);
  for (std::size_t w = 0; w < words; ++w) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      std::memcpy(out + 4 * (w * lane_count + lane), &word[w], 4);
    }
  }
  return block;
}

/// Reads one lane of a block as a row; `put_row` writes a row into one lane.
template <template <class> class C>
C<float> row_of(const C<Lanes<float>>& block, std::size_t lane) {
  C<float> row;
  const auto* in = reinterpret_cast<const std::byte*>(&block) + 4 * lane;
  auto* out = reinterpret_cast<std::byte*>(&row);
  for (std::size_t w = 0; w < sizeof(row) / 4; ++w) std::memcpy(out + 4 * w, in + 4 * w * lane_count, 4);
  return row;
}
template <template <class> class C>
void put_row(const C<float>& row, C<Lanes<float>>& block, std::size_t lane) {
  const auto* in = reinterpret_cast<const std::byte*>(&row);
  auto* out = reinterpret_cast<std::byte*>(&block) + 4 * lane;
  for (std::size_t w = 0; w < sizeof(row) / 4; ++w) std::memcpy(out + 4 * w * lane_count, in + 4 * w, 4);
}
template <template <class> class C>
C<float> first_lane(const C<Lanes<float>>& block) {
  return row_of(block, 0);
}

}  // namespace mobil::inline v0_3
