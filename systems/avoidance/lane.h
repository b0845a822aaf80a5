#pragma once
// Which lane a walker takes where others come the other way: between the wish and the next step.

#include <cstdint>
#include <span>

#include <mobil/components/avoidance.h>
#include <mobil/systems/avoidance/obstacles.h>
#include "systems/avoidance/reservations.h"

namespace mobil::inline v0_3 {

/// The place of a wall that is nearest to `to`, m.
GroundPoint nearest_of(const Wall& wall, GroundPoint to);

/// The heading, rad, of the walker whose reservation is `me` and who wants to go as `course` says: toward that lane,
/// straight on or beside it, in which the fewest people come the other way. Where many come, lanes to the right cost
/// less, so that the two flows part. No lane is behind a wall. From any thread.
float lane_heading(const ReservationBook& book, std::span<const BoxedWall> walls, std::uint32_t me,
                   const AvoidanceState<float>& course);

}  // namespace mobil::inline v0_3
