#pragma once
// The sixteen steps that a walker can choose from at a heel strike. The first one is the reservation's: to stop as soon
// as possible, or to stay.

#include <mobil/components/avoidance.h>
#include "systems/avoidance/ways.h"

namespace mobil::inline v0_3 {

inline constexpr std::size_t reserved = 0;

/// Kind of the gait request of a trial.
enum class TrialKind : std::uint8_t { go, stay, turn, aside };

struct Trials {
  Trial<Lanes<float>> trial;
  TrialKind kind[lane_count];
  float wish_rad;  // turn to the desired heading
};

/// Returns an angle within half a turn of 0, rad.
float wrapped(float angle_rad);

/// Returns the trials. A walking person has three speeds with five turns each. A standing one has six starts at two
/// speeds, a turn on the spot to either side, and seven steps: aside, back, ahead and diagonally.
Trials make_trials(const HeelStrikePlace<float>& at, const AvoidanceState<float>& course);

}  // namespace mobil::inline v0_3
