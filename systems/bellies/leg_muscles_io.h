#pragma once
// Leg muscle choices as words, for hashes and snapshots.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <mobil/components/leg_muscles.h>

namespace mobil::inline v0_3 {

inline constexpr std::size_t choice_word_count = 31;
using LegMusclesWords = std::array<std::uint64_t, choice_word_count>;

/// Returns all fields in a fixed order, doubles bit by bit.
LegMusclesWords leg_muscles_words(const LegMuscles& choice);
/// Returns the choice with those words, or nothing if an enumeration, a bool or a count is out of range.
std::optional<LegMuscles> choice_of(const LegMusclesWords& words);
/// Returns a hash that is equal for equal choices.
std::uint64_t hash_of(const LegMuscles& choice);

}  // namespace mobil::inline v0_3
