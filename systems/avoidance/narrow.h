#pragma once
// Who turns the shoulders, so that two pass through a gap that is narrower than both.

#include <mobil/engine/jobs.h>
#include "systems/avoidance/reservations.h"

namespace mobil::inline v0_3 {

/// Writes to AvoidanceState::turn_to_rad how far those turn their shoulders who avoid others: so far that the gap
/// between two who come near is wide enough for both. One person in eight is looked at in a tick, by the entity's
/// index. It follows from reservations alone, not from the order of people.
void narrow_shoulders(const ReservationBook& book, const Jobs& jobs, std::uint32_t tick);

}  // namespace mobil::inline v0_3
