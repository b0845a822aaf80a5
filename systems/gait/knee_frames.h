#pragma once
// Frames of legs relative to their knees.

#include <array>
#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/leg_frames.h>
#include <mobil/components/step_plan.h>
#include "engine/fetch_ahead.h"

namespace mobil::inline v0_3 {

/// Prefetch of a plan without the parts that legs do not read: lean of the trunk, pressure of the feet, swing of the
/// arms.
class LegPlanAhead {
 public:
  /// Prefetches nothing if `plan` is null.
  explicit LegPlanAhead(const StepPlan<Lanes<float>>* plan);
  /// Prefetches this many more lines of 64 bytes.
  void fetch(std::size_t lines) {
    while (part_ < parts_.size() && (lines = parts_[part_].fetch(lines)) > 0) ++part_;
  }

 private:
  std::array<FetchAhead, 7> parts_;
  std::size_t part_ = 0;
};

/// Computes both legs, right first, of the pose that `pose_skeleton` would write for a step
/// (systems/gait/kinematics.h), without the pose. It serves unseen muscles. Near the origin positions are within 5 µm
/// of the pose's, and far from it they lose no digits. `ahead` is prefetched meanwhile.
void knee_frames(const BodySize<Lanes<float>>& size, const StepPlan<Lanes<float>>& plan,
                 const GaitState<Lanes<float>>& state, KneeFrame<Lanes<float>> (&leg)[2], LegPlanAhead& ahead);

}  // namespace mobil::inline v0_3
