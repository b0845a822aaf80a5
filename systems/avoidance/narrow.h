#pragma once
// Who turns the shoulders, so that two pass through a gap that is narrower than both.

#include "engine/jobs.h"
#include "systems/avoidance/claims.h"

namespace mobil {

/// Half of the depth of shoulders with their arms, of half their breadth.
inline constexpr float depth_part = 0.58F;

/// How far shoulders of half a breadth reach toward a direction (a unit vector), m, that face where (sine, cosine)
/// says: those of an ellipse.
float reach_of(float shoulders_m, float faces_x, float faces_z, float toward_x, float toward_z);

/// Writes how far those are to turn the shoulders who avoid others: so that what two who come near have between them is
/// enough for both, each its part. One person in eight is looked at in a tick, by their number. It follows from claims
/// alone, not from the order of people.
void narrow_shoulders(const ClaimBook& book, const Jobs& jobs, std::uint32_t tick);

}  // namespace mobil
