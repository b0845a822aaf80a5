#pragma once
// Numbers that tell states apart: 64 bits of each row of a table, and of bytes.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/engine/table.h>

namespace mobil::inline v0_3 {

/// A bijection that scatters bits (the finaliser of splitmix64; Steele, Lea and Flood 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Words of a component that say nothing of the row itself, such as handles.
struct IgnoredWords {
  std::uint64_t id = 0;
  std::uint32_t first = 0, count = 0;
};

/// One number for each row of the blocks from `first` up to `end`, the first one's in out[0] (sixteen a block, and room
/// for as many): of all its words but those ignored, and of `seed`, which stands for the table's key. Where in the
/// table a row lies does not matter. One changed word always changes its row's number.
void hash_rows(const Table& table, std::size_t first, std::size_t end, std::uint64_t seed,
               std::span<const IgnoredWords> ignored, std::uint64_t* out);

/// One number for bytes and how many they are. Changes within one aligned word of four always change it.
std::uint64_t hash_bytes(const void* bytes, std::size_t count);

}  // namespace mobil::inline v0_3
