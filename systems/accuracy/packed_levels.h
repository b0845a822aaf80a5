#pragma once
// Levels packed into a person's row, and other helpers shared by the parts of level of detail.

#include <cmath>
#include <cstdint>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/systems/accuracy/lod_table.h>

namespace mobil::inline v0_3 {

inline constexpr float default_tolerance_m = 0.001F;

inline bool positive(double value) {
  return value > 0 && std::isfinite(value);
}

/// Special values of a level: forced by the caller, or refused by Simulation. Neither is changed.
inline constexpr std::uint32_t forced_level = 15, refused_level = 14;

/// Returns true if muscles of a choice use the LodTable of active muscles.
inline bool pulls_alive(const LegMuscles& choice) {
  return has_activation(choice) && choice.finite_shape.value_or(true);
}
/// Returns the level of a method, or the level of about the same cost. An untuned moving belly of an active muscle
/// counts as static, because its motion brings it no closer to active tissue.
std::uint32_t level_of(const MuscleMethod& method, bool active);

inline std::uint32_t level_at(const std::uint32_t* packed, std::uint32_t muscle) {
  return packed[muscle / 8] >> (4 * (muscle % 8)) & 15U;
}
inline void set_level(std::uint32_t* packed, std::uint32_t muscle, std::uint32_t level) {
  const std::uint32_t shift = 4 * (muscle % 8);
  packed[muscle / 8] = (packed[muscle / 8] & ~(15U << shift)) | level << shift;
}
inline bool is_active(const LodState<float>& lod_state) {
  return (lod_state.effects & lod_active) != 0;
}
/// Selects the level figures that apply to a person's muscle.
inline LevelCase level_case(const LodState<float>& lod_state, std::uint32_t muscle, bool points) {
  return {muscle, lod_state.speed_step, (lod_state.effects & lod_inertia) != 0, points, is_active(lod_state)};
}
/// Bits of muscles in words of a row.
using MuscleWords = std::uint32_t[max_muscles / 32];
inline bool bit_at(const MuscleWords& bits, std::uint32_t muscle) {
  return (bits[muscle / 32] >> (muscle % 32) & 1U) != 0;
}
inline void set_bit(MuscleWords& bits, std::uint32_t muscle, bool on) {
  std::uint32_t& word = bits[muscle / 32];
  word = (word & ~(1U << (muscle % 32))) | (on ? 1U : 0U) << (muscle % 32);
}
inline std::uint64_t all_bits(const MuscleWords& bits) {
  return join_muscles(bits[0], bits[1]).to_ullong();
}
inline void set_bits(MuscleWords& bits, const MuscleSet& all) {
  split_muscles(all, bits[0], bits[1]);
}

}  // namespace mobil::inline v0_3
