#pragma once
// Levels packed into a person's row, and other helpers that the parts of level of detail share.

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

/// Instead of a level: the caller chose, or Simulation refused; both are left alone.
inline constexpr std::uint32_t forced_level = 15, refused_level = 14;

/// Whether muscles of a choice have the lod_table of those that pull.
inline bool pulls_alive(const LegMuscles& choice) {
  return has_activation(choice) && choice.finite_shape.value_or(true);
}
/// The level that a method is, or the one that it costs about as much as. What pulls and moves, but is not tuned, is no
/// nearer to active tissue than static answers are.
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
/// Which of the levels' figures are those of a person's muscle.
inline LevelCase level_case(const LodState<float>& lod_state, std::uint32_t muscle, bool points) {
  return {muscle, lod_state.speed_step, (lod_state.effects & lod_inertia) != 0, points, is_active(lod_state)};
}
inline bool bit_at(std::uint32_t bits, std::uint32_t muscle) {
  return (bits >> muscle & 1U) != 0;
}
inline void set_bit(std::uint32_t& bits, std::uint32_t muscle, bool on) {
  bits = (bits & ~(1U << muscle)) | (on ? 1U : 0U) << muscle;
}

}  // namespace mobil::inline v0_3
