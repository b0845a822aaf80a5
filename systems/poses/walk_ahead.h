#pragma once
// Walkers a part of a tick later; the world does not change.

#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/step_plan.h>
#include <mobil/engine/entity.h>
#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

class Table;
class World;

/// Maximum time ahead, s. It is shorter than any step, so that at most one step begins in it.
inline constexpr double furthest_ahead_s = 0.2;
/// Fails on a time outside 0 to furthest_ahead_s.
Result<void> check_ahead(double ahead_s);

/// A block of walkers `ahead_s` later, for times above 0. A step that begins in that time is solved as the tick will
/// solve it.
class WalkAhead {
 public:
  WalkAhead(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
            const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, float ahead_s);
  WalkAhead(const WalkAhead&) = delete;
  WalkAhead& operator=(const WalkAhead&) = delete;

  const StepPlan<Lanes<float>>& plan() const { return *plan_; }
  const GaitState<Lanes<float>>& state() const { return state_; }
  /// Null on level ground. Ground after the current step is taken to be as high as the foothold that ends the step.
  const Footing<Lanes<float>>* footing() const { return uneven_ ? &footing_ : nullptr; }

 private:
  GaitState<Lanes<float>> state_;
  const StepPlan<Lanes<float>>* plan_;
  StepPlan<Lanes<float>> next_;
  bool uneven_;
  Footing<Lanes<float>> footing_;
};

/// Computes the pose of a block of walkers `ahead_s` after the last tick, 0 to furthest_ahead_s. Shoulders turned for
/// avoidance keep their present rotation.
void pose_ahead(const Table& table, std::size_t block, float ahead_s, Pose<Lanes<float>>& pose);
/// Returns the same of one person who is awake; of a posed person, the pose on the row.
Pose<float> pose_ahead(const World& world, Entity person, float ahead_s);

}  // namespace mobil::inline v0_3
