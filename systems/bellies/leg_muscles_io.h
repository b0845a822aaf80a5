#pragma once
// A choice of leg muscles as words: what its hash mixes and what a snapshot keeps.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <mobil/components/leg_muscles.h>

namespace mobil::inline v0_3 {

inline constexpr std::size_t choice_word_count = 31;
using LegMusclesWords = std::array<std::uint64_t, choice_word_count>;

/// All fields, in a fixed order; doubles bit by bit.
LegMusclesWords leg_muscles_words(const LegMuscles& choice);
/// The choice that has those words; nothing where an enumeration, a bool or a count is out of range.
std::optional<LegMuscles> choice_of(const LegMusclesWords& words);
/// Equal for equal choices.
std::uint64_t hash_of(const LegMuscles& choice);

}  // namespace mobil::inline v0_3
