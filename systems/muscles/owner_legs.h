#pragma once
// The one gather of a tick: each muscle's row looks up the leg that its person published.

#include <mobil/components/leg_frames.h>
#include <mobil/components/muscle.h>
#include <mobil/engine/access.h>

namespace mobil::inline v0_3 {

using LegsOfOwners = LookupPublished<PublishedLeg>;

/// The legs of a block's owners; those of the block `ahead` are fetched meanwhile. A muscle whose person is gone has a
/// leg that stands still at the origin.
LegFrames<Lanes<float>> legs_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner,
                                Ahead<MuscleOwner> ahead);
/// Where these legs are in their walk.
LegClock<Lanes<float>> clocks_of(const LegsOfOwners& posts, const MuscleOwner<Lanes<float>>& owner);

}  // namespace mobil::inline v0_3
