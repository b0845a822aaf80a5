#pragma once
// The sixteen steps that a walker may choose from at a heel strike. The first is what the walker's reservation has: to
// stop as soon as may be, or to stay.

#include <mobil/components/avoidance.h>
#include "systems/avoidance/ways.h"

namespace mobil::inline v0_3 {

inline constexpr std::size_t reserved = 0;

/// How a trial is asked for.
enum class TrialKind : std::uint8_t { go, stay, turn, aside };

struct Trials {
  Trial<Lanes<float>> trial;
  TrialKind kind[lane_count];
  float wish_rad;  // the turn to where the walker wants to go
};

/// An angle within half a turn of 0, rad.
float wrapped(float angle_rad);

/// Of who walks: three speeds, five turns each. Of who stands: starts at two speeds and five turns, turns on the spot
/// either way, steps aside to either side and back.
Trials make_trials(const HeelStrikePlace<float>& at, const AvoidanceState<float>& course);

}  // namespace mobil::inline v0_3
