// Sixteen lanes are hashed in parallel, each in two 32-bit words with different mixing. Each step is a bijection in the
// lane's words and in the incoming word.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE __BASE_FILE__
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace mobil::inline v0_3::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Mixes `count` lines of sixteen words into both halves of sixteen hashes.
void hash_lines(const std::uint8_t* line, std::size_t count, std::uint32_t* low, std::uint32_t* high) {
  const hn::CappedTag<std::uint32_t, 16> d;
  const hn::Repartition<std::uint8_t, decltype(d)> bytes;
  constexpr std::size_t width = hn::MaxLanes(d), parts = 16 / width;
  hn::Vec<decltype(d)> a[parts], b[parts];
  for (std::size_t i = 0; i < parts; ++i) {
    a[i] = hn::LoadU(d, low + i * width);
    b[i] = hn::LoadU(d, high + i * width);
  }
  const auto first = hn::Set(d, 0x9e3779b1U), second = hn::Set(d, 0x85ebca6bU);
  for (; count != 0; --count, line += 64) {
    for (std::size_t i = 0; i < parts; ++i) {
      const auto word = hn::BitCast(d, hn::LoadU(bytes, line + 4 * i * width));
      a[i] = hn::RotateRight<17>(hn::Mul(hn::Xor(a[i], word), first));
      b[i] = hn::Mul(hn::RotateRight<19>(hn::Add(b[i], word)), second);
    }
  }
  for (std::size_t i = 0; i < parts; ++i) {
    hn::StoreU(a[i], d, low + i * width);
    hn::StoreU(b[i], d, high + i * width);
  }
}

}  // namespace mobil::inline v0_3::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cstring>

#include <mobil/components/lanes.h>
#include "engine/row_hash.h"

namespace mobil::inline v0_3 {
namespace {

HWY_EXPORT(hash_lines);

struct LaneHashes {
  std::uint32_t low[lane_count], high[lane_count];

  explicit LaneHashes(std::uint64_t seed) {
    for (std::size_t l = 0; l < lane_count; ++l) {
      low[l] = static_cast<std::uint32_t>(seed);
      high[l] = static_cast<std::uint32_t>(seed >> 32);
    }
  }
  void take(const void* lines, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(hash_lines)(static_cast<const std::uint8_t*>(lines), count, low, high);
  }
  std::uint64_t lane(std::size_t l) const { return std::uint64_t{high[l]} << 32 | low[l]; }
};

}  // namespace

void hash_rows(const Table& table, std::size_t first, std::size_t end, std::uint64_t seed,
               std::span<const IgnoredWords> ignored, std::uint64_t* out) {
  for (std::size_t b = first; b < end; ++b) {
    LaneHashes hashes(seed);
    const float* block = table.block(b);
    std::uint32_t from = 0;
    // Columns are in the order of their ids; ignored words can be in any order.
    for (std::uint32_t at = 0; at < table.words();) {
      std::uint32_t skip_from = table.words(), skip_to = table.words();
      for (const IgnoredWords& words : ignored) {
        const std::uint32_t column = table.column(words.id);
        if (column == Table::no_column || column + words.first < from || column + words.first >= skip_from) continue;
        skip_from = column + words.first;
        skip_to = skip_from + words.count;
      }
      hashes.take(block + at * lane_count, skip_from - at);
      at = from = skip_to;
    }
    for (std::size_t l = 0; l < lane_count; ++l) *out++ = mix64(hashes.lane(l));
  }
}

std::uint64_t hash_bytes(const void* bytes, std::size_t count) {
  constexpr std::size_t line = 4 * lane_count;
  LaneHashes hashes(0x243f6a8885a308d3);
  hashes.take(bytes, count / line);
  if (const std::size_t rest = count % line; rest != 0) {
    std::byte last[line] = {};
    std::memcpy(last, static_cast<const std::byte*>(bytes) + (count - rest), rest);
    hashes.take(last, 1);
  }
  std::uint64_t hash = mix64(count);
  for (std::size_t l = 0; l < lane_count; ++l) hash = mix64(hash ^ hashes.lane(l));
  return hash;
}

}  // namespace mobil::inline v0_3
#endif
