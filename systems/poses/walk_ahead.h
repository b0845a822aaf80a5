#pragma once
// Walkers a part of a tick later: nothing in the world changes.

#include <cstddef>

#include <mobil/components/body.h>
#include <mobil/components/footing.h>
#include <mobil/components/gait.h>

namespace mobil::inline v0_3 {

/// How far ahead may be asked for, s: less than any step takes, so that one at most begins on the way.
inline constexpr double furthest_ahead_s = 0.2;

/// A block of walkers where they will be `ahead_s` later, above 0; who begins a step on the way takes the one that they
/// will.
class WalkAhead {
 public:
  WalkAhead(const BodySize<Lanes<float>>& size, const Gait<Lanes<float>>& gait, const StepPlan<Lanes<float>>& plan,
            const GaitState<Lanes<float>>& state, const Footing<Lanes<float>>* footing, float ahead_s);
  WalkAhead(const WalkAhead&) = delete;
  WalkAhead& operator=(const WalkAhead&) = delete;

  const StepPlan<Lanes<float>>& plan() const { return *plan_; }
  const GaitState<Lanes<float>>& state() const { return state_; }
  /// Null on level ground. What comes after the step under way is as high as what it ends on.
  const Footing<Lanes<float>>* footing() const { return uneven_ ? &footing_ : nullptr; }

 private:
  GaitState<Lanes<float>> state_;
  const StepPlan<Lanes<float>>* plan_;
  StepPlan<Lanes<float>> next_;
  bool uneven_;
  Footing<Lanes<float>> footing_;
};

}  // namespace mobil::inline v0_3
