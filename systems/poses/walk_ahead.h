#pragma once
// Walkers a part of a tick later; the world does not change.

#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// Maximum time ahead, s. It is shorter than any step, so that at most one step begins in it.
inline constexpr double furthest_ahead_s = 0.2;

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

}  // namespace mobil::inline v0_3
