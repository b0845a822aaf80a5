#pragma once
// Rows in and out of blocks, for what the front door computes of one person.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "components/gait.h"
#include "components/lanes.h"

namespace mobil {

/// One row in all sixteen lanes.
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

/// Lane 0 of a block as a row.
template <template <class> class C>
C<float> first_lane(const C<Lanes<float>>& block) {
  C<float> row;
  const auto* in = reinterpret_cast<const std::byte*>(&block);
  auto* out = reinterpret_cast<std::byte*>(&row);
  for (std::size_t w = 0; w < sizeof(row) / 4; ++w) std::memcpy(out + 4 * w, in + 4 * w * lane_count, 4);
  return row;
}

/// Where a walker was some seconds before, as far as the present step and one like it before that tell.
std::optional<GaitState<float>> earlier(GaitState<float> state, const StepPlan<float>& plan, float seconds);

}  // namespace mobil
