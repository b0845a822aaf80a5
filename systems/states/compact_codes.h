#pragma once
// Layout of a compact row's tag and fields (mobil/components/compact.h).

#include <cstddef>
#include <cstdint>

#include <mobil/components/compact.h>
#include <mobil/components/leg_frames.h>

namespace mobil::inline v0_3 {

inline constexpr std::uint32_t code_bits = 5, max_compact = 64 / code_bits;

inline std::uint32_t code_at(std::uint64_t codes, std::size_t place) {
  return static_cast<std::uint32_t>(codes >> (code_bits * place)) & 31U;
}
/// Returns true if a muscle of that code has modes; the code is their number.
inline bool moves(std::uint32_t code) {
  return code != compact_none && code != compact_static;
}

/// Position of a muscle in a person's fields: number of words before it.
struct CompactLayout {
  std::uint32_t state = 0, motion = sizeof(LegScale<float>) / sizeof(float);
  void skip(std::uint32_t modes) {
    state += 2 * (1 + 2 * modes);
    motion += 1 + 3 * modes;
  }
};
/// Returns the width of the fields. A row without moving muscles has no fields.
inline CompactLayout compact_width(std::uint64_t codes) {
  CompactLayout all;
  for (std::size_t place = 0; place < max_compact; ++place)
    if (const std::uint32_t code = code_at(codes, place); moves(code)) all.skip(code);
  return all;
}

}  // namespace mobil::inline v0_3
