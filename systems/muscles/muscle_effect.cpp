#include "systems/muscles/muscle_effect.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "systems/muscles/activation_effect.h"
#include "systems/muscles/finite_shape_effect.h"
#include "systems/muscles/inertia_effect.h"
#include "systems/muscles/line_motion_effect.h"

namespace mobil::inline v0_3 {

void RowValues::set(std::uint64_t part, const void* words, std::size_t count) {
  values_.push_back({part, words_.size(), count});
  words_.resize(words_.size() + count);
  std::memcpy(&words_[words_.size() - count], words, 4 * count);
}

const float* RowValues::find(std::uint64_t part) const {
  const auto found = std::find_if(values_.rbegin(), values_.rend(), [&](const Value& v) { return v.part == part; });
  return found == values_.rend() ? nullptr : &words_[found->first];
}

std::span<const MuscleEffect> muscle_effects() {
  static const std::array all = {line_motion_effect, activation_effect, inertia_effect, finite_shape_effect};
  return all;
}

}  // namespace mobil::inline v0_3
