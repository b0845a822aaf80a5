#pragma once
// Legs as their own knees see them.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include "engine/fetch_ahead.h"

namespace mobil::inline v0_3 {

/// A plan that will be needed soon, without what legs do not read of it: how the trunk leans, what the feet press, how
/// arms swing.
class LegPlanAhead {
 public:
  /// Nothing is fetched where `plan` is null.
  explicit LegPlanAhead(const StepPlan<Lanes<float>>* plan);
  /// So many lines of 64 bytes more.
  void fetch(std::size_t lines) {
    while (part_ < parts_.size() && (lines = parts_[part_].fetch(lines)) > 0) ++part_;
  }

 private:
  std::array<FetchAhead, 7> parts_;
  std::size_t part_ = 0;
};

/// Both legs of the pose that `pose_skeleton` makes of a step (systems/gait/kinematics.h), right first, without
/// the pose: for muscles that nobody looks at. Places are within 5 µm of the pose's near the origin, and lose no digits
/// far from it. `ahead` is fetched on the way.
void knee_frames(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, KneeFrame<Lanes<float>> (&leg)[2], LegPlanAhead& ahead);

}  // namespace mobil::inline v0_3
