#pragma once
// The one gather of a tick: each muscle's row looks up the leg that its person published.

#include "components/leg_frames.h"
#include "components/muscle.h"
#include "engine/access.h"

namespace mobil {

using LegsOfOwners = LookupPublished<LegPost>;

/// The legs of a block's owners; those of the block `ahead` are fetched meanwhile. A muscle whose person is gone has a
/// leg that stands still at the origin.
LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead);
/// Where these legs are in their walk.
LegClock<Lanes<float>> clocks_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner);

}  // namespace mobil
