#pragma once
// Copies rows into and out of the lanes of a block. Both consist of 4-byte words.

#include <cstddef>
#include <cstring>

#include <mobil/components/lanes.h>

namespace mobil {

/// Writes one row into one lane of a block.
template <class Row, class Block>
void put(const Row& row, Block& block, std::size_t lane) {
  static_assert(sizeof(Block) == lane_count * sizeof(Row));
  for (std::size_t i = 0; i < sizeof(Row) / 4; ++i)
    std::memcpy(reinterpret_cast<char*>(&block) + 4 * (i * lane_count + lane),
                reinterpret_cast<const char*>(&row) + 4 * i, 4);
}

/// Returns one lane of a block as a row.
template <template <class> class C>
C<float> row(const C<Lanes<float>>& block, std::size_t lane) {
  C<float> r;
  for (std::size_t i = 0; i < sizeof(r) / 4; ++i)
    std::memcpy(reinterpret_cast<char*>(&r) + 4 * i,
                reinterpret_cast<const char*>(&block) + 4 * (i * lane_count + lane), 4);
  return r;
}

inline Vec3<float> at(const Vec3<Lanes<float>>& v, std::size_t l) {
  return {v.x[l], v.y[l], v.z[l]};
}
inline Quat<float> at(const Quat<Lanes<float>>& q, std::size_t l) {
  return {q.x[l], q.y[l], q.z[l], q.w[l]};
}

}  // namespace mobil
