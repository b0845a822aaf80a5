#pragma once
// Choice of a lane among oncoming people, between the desired velocity and the next step.

#include <cstdint>
#include <span>

#include <mobil/components/avoidance.h>
#include <mobil/systems/avoidance/obstacles.h>
#include "systems/avoidance/reservations.h"

namespace mobil::inline v0_3 {

/// Returns the point of a wall that is nearest to `to`, m.
GroundPoint nearest_of(const Wall& wall, GroundPoint to);

/// Returns the heading, rad, of the walker with reservation `me` and the desired velocity in `course`. It leads to the
/// lane, straight ahead or to a side, with the fewest oncoming people. Among many oncoming people, lanes to the right
/// cost less, so that the two flows part. Lanes behind walls are avoided. Callable from any thread.
float lane_heading(const ReservationBook& book, std::span<const BoxedWall> walls, std::uint32_t me,
                   const AvoidanceState<float>& course);

}  // namespace mobil::inline v0_3
