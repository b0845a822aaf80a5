#pragma once
// Whether a walk is a motion that the ground's forces on it could make: what the ground's moment about the centre of
// mass is beside the rate of the body's angular momentum.

#include <array>
#include <string_view>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait_style.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/engine/error.h>
#include <mobil/forces.h>

namespace mobil {

/// Moment of the ground less the rate of angular momentum of all 48 segments about their common centre of mass, N m per
/// kg of body, about the axis across the pelvis (`pitch`) and along it (`roll`). About the vertical nothing is said:
/// what a foot's friction bears there is no part of the ground reaction.
struct UnbalancedMoment {
  double pitch_rms = 0, pitch_peak = 0, roll_rms = 0, roll_peak = 0;
};

/// Adds up a person's unbalanced moment tick by tick. Segments' inertias are those of assets/body/segment_inertia.h;
/// velocities are differences of places, so ticks should be short and the person near the origin.
class BalanceMeter {
 public:
  explicit BalanceMeter(const Body& body);
  /// After each tick of `tick_s`: the pose and the ground reaction. Nothing is known in the first two.
  void add(const Pose<float>& pose, const GroundReaction<float>& ground, double tick_s);
  UnbalancedMoment result() const;

 private:
  struct Moving {
    Vec3<double> centre, forward, momentum;  // common centre of mass; the pelvis' heading; angular momentum
  };
  Moving between(const Pose<float>& before, const Pose<float>& after, double span_s) const;

  std::array<double, segment_count> mass_{};
  std::array<Vec3<double>, segment_count> centre_{}, inertia_{};
  double total_kg_ = 0;
  std::vector<Pose<float>> last_;   // up to three, the newest last
  GroundReaction<float> ground_{};  // at the middle one
  std::size_t counted_ = 0;
  double pitch_squares_ = 0, roll_squares_ = 0, pitch_peak_ = 0, roll_peak_ = 0;
};

/// One thing that people do while they walk.
struct BalancedScene {
  std::string_view name;
  UnbalancedMoment moment;
};

/// Straight on, faster and slower, turning, starting and stopping, limping. Errors: a body or style out of range.
Result<std::vector<BalancedScene>> walk_balance_scenes(const BodyRequest& body, const GaitStyle& style);

}  // namespace mobil
