#pragma once
// 64-bit hashes of a table's rows and of bytes.

#include <cstddef>
#include <cstdint>
#include <span>

#include <mobil/engine/table.h>

namespace mobil::inline v0_3 {

/// Returns a bijective mix of x (the finaliser of splitmix64; Steele, Lea and Flood 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Words of a component that are not state of the row itself, such as handles.
struct IgnoredWords {
  std::uint64_t id = 0;
  std::uint32_t first = 0, count = 0;
};

/// Writes a hash of each row of the blocks from `first` up to `end`: sixteen a block, all of them written, from out[0]
/// on. It covers all words except the ignored ones, and `seed`, which represents the table's key. It does not depend on
/// the row's position. Changing one word always changes the hash.
void hash_rows(const Table& table, std::size_t first, std::size_t end, std::uint64_t seed,
               std::span<const IgnoredWords> ignored, std::uint64_t* out);

/// Returns a hash of bytes and their count. Changes within one aligned word of four bytes always change it.
std::uint64_t hash_bytes(const void* bytes, std::size_t count);

}  // namespace mobil::inline v0_3
