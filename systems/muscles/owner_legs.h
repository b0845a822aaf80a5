#pragma once
// The only gather of a tick: each muscle's row looks up the leg that its person published.

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/access.h>

namespace mobil::inline v0_3 {

using LegsOfOwners = LookupPublished<PublishedLeg>;

/// Returns the legs of a block's owners, and prefetches for the blocks `ahead`. A muscle whose person is gone gets a
/// motionless leg at the origin.
LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead);
/// Returns the positions of these legs in the gait cycle.
LegClock<Lanes<float>> clocks_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner);

}  // namespace mobil::inline v0_3
