#pragma once
// Rungs packed into a person's row, and rows out of blocks without a detour. Part of Relevance.

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "components/lanes.h"
#include "components/relevance.h"

namespace mobil {

/// Instead of a rung: the caller chose, or Simulation refused; both are left alone.
inline constexpr std::uint32_t forced_rung = 15, refused_rung = 14;

inline std::uint32_t rung_at(const std::uint32_t* packed, std::uint32_t muscle) {
  return packed[muscle / 8] >> (4 * (muscle % 8)) & 15U;
}
inline void set_rung(std::uint32_t* packed, std::uint32_t muscle, std::uint32_t rung) {
  const std::uint32_t shift = 4 * (muscle % 8);
  packed[muscle / 8] = (packed[muscle / 8] & ~(15U << shift)) | rung << shift;
}
inline bool bit_at(std::uint32_t bits, std::uint32_t muscle) {
  return (bits >> muscle & 1U) != 0;
}
inline void set_bit(std::uint32_t& bits, std::uint32_t muscle, bool on) {
  bits = (bits & ~(1U << muscle)) | (on ? 1U : 0U) << muscle;
}

/// One lane of a component whose first word in the block is `column`.
template <class Row>
Row read_lane(const float* block, std::uint32_t column, std::size_t lane) {
  Row row;
  auto* out = reinterpret_cast<std::byte*>(&row);
  for (std::size_t w = 0; w < sizeof(Row) / 4; ++w)
    std::memcpy(out + 4 * w, block + (column + w) * lane_count + lane, 4);
  return row;
}
template <class Row>
void write_lane(const Row& row, float* block, std::uint32_t column, std::size_t lane) {
  const auto* in = reinterpret_cast<const std::byte*>(&row);
  for (std::size_t w = 0; w < sizeof(Row) / 4; ++w)
    std::memcpy(block + (column + w) * lane_count + lane, in + 4 * w, 4);
}

}  // namespace mobil
