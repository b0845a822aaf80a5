#pragma once
// Which lane a walker takes where others come the other way: between the wish and the next step.

#include <cstdint>
#include <span>

#include "components/avoidance.h"
#include "systems/avoidance/claims.h"
#include "systems/avoidance/obstacles.h"

namespace mobil {

/// The place of a wall that is nearest to `to`, m.
GroundPoint nearest_of(const Wall& wall, GroundPoint to);

/// Where to head, rad, for somebody of claim `me` who is at `at` and wants to go as `course` says: toward the lane
/// beside the way straight on in which fewest people come the other way. Where people come, lanes to the right cost
/// less, so that the two flows part. Lanes that a wall closes are not taken. From any thread.
float lane_heading(const ClaimBook& book, std::span<const Wall> walls, std::uint32_t me, const Course<float>& course,
                   GroundPoint at);

}  // namespace mobil
