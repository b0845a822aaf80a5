#pragma once
// Rungs packed into a person's row, and other helpers that the parts of level of detail share.

#include <cmath>
#include <cstdint>

#include <mobil/components/leg_muscles.h>
#include <mobil/components/lod.h>
#include <mobil/systems/accuracy/ladder.h>

namespace mobil::inline v0_3 {

inline constexpr float default_tolerance_m = 0.001F;

inline bool positive(double value) {
  return value > 0 && std::isfinite(value);
}

/// Instead of a rung: the caller chose, or Simulation refused; both are left alone.
inline constexpr std::uint32_t forced_rung = 15, refused_rung = 14;

/// Whether muscles of a choice have the ladder of those that pull.
inline bool pulls_alive(const LegMuscles& choice) {
  return has_activation(choice) && choice.finite_shape.value_or(true);
}
/// The rung that a method is, or the one that it costs about as much as. What pulls and moves, but is not tuned, is no
/// nearer to living tissue than static answers are.
std::uint32_t rung_of(const MuscleMethod& method, bool living);

inline std::uint32_t rung_at(const std::uint32_t* packed, std::uint32_t muscle) {
  return packed[muscle / 8] >> (4 * (muscle % 8)) & 15U;
}
inline void set_rung(std::uint32_t* packed, std::uint32_t muscle, std::uint32_t rung) {
  const std::uint32_t shift = 4 * (muscle % 8);
  packed[muscle / 8] = (packed[muscle / 8] & ~(15U << shift)) | rung << shift;
}
inline bool is_living(const Tiers<float>& tiers) {
  return (tiers.effects & tier_living) != 0;
}
/// Which of the ladders' figures are those of a person's muscle.
inline RungCase rung_case(const Tiers<float>& tiers, std::uint32_t muscle, bool points) {
  return {muscle, tiers.speed_step, (tiers.effects & tier_inertia) != 0, points, is_living(tiers)};
}
inline bool bit_at(std::uint32_t bits, std::uint32_t muscle) {
  return (bits >> muscle & 1U) != 0;
}
inline void set_bit(std::uint32_t& bits, std::uint32_t muscle, bool on) {
  bits = (bits & ~(1U << muscle)) | (on ? 1U : 0U) << muscle;
}

}  // namespace mobil::inline v0_3
