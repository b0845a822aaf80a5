#include "systems/muscles/muscle_effect.h"

#include <array>
#include <cstring>

#include "systems/muscles/inertia_effect.h"
#include "systems/muscles/line_motion_effect.h"

namespace mobil {

void RowValues::set(std::uint64_t part, const void* words, std::size_t count) {
  values_.push_back({part, words_.size(), count});
  words_.resize(words_.size() + count);
  std::memcpy(&words_[words_.size() - count], words, 4 * count);
}

const float* RowValues::find(std::uint64_t part) const {
  for (const Value& value : values_) {
    if (value.part == part) return &words_[value.first];
  }
  return nullptr;
}

std::span<const MuscleEffect> muscle_effects() {
  static const std::array all = {line_motion_effect, inertia_effect};
  return all;
}

}  // namespace mobil
