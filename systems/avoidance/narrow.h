#pragma once
// Turning of shoulders, so that two people pass through a gap that is narrower than both.

#include <mobil/engine/jobs.h>
#include "systems/avoidance/reservations.h"

namespace mobil::inline v0_3 {

/// Writes AvoidanceState::turn_to_rad of people who avoid others: the turn at which the gap between two people who come
/// near is wide enough for both. Each tick handles one person in eight, by entity index. The result follows from
/// reservations alone, not from the order of people.
void narrow_shoulders(const ReservationBook& book, const Jobs& jobs, std::uint32_t tick);

}  // namespace mobil::inline v0_3
