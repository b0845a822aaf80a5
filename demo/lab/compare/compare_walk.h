#pragma once
// One steady stride of a simulated walk, sampled like published measurements; and its dynamic balance: whether the
// ground's forces can cause its motion.

#include <functional>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/components/pose.h>
#include <mobil/components/segments.h>
#include <mobil/forces.h>
#include <mobil/simulation.h>
#include "demo/lab/compare/compare_reference.h"

namespace mobil {

/// Returns the leg's length over that of a man of 1.75 m.
double leg_ratio(const BodyRequest& body);
/// Returns the factor from that man's speeds to those in proportion to shorter legs; 1 for longer ones.
float pace_of(const BodyRequest& body);

/// Moment of the ground minus the rate of angular momentum of all 48 segments about their common centre of mass, N m
/// per kg of body. `pitch` is about the axis across the pelvis, `roll` about the one along it, `yaw` about the
/// vertical.
struct UnbalancedMoment {
  double pitch_rms = 0, pitch_peak = 0, roll_rms = 0, roll_peak = 0, yaw_rms = 0, yaw_peak = 0;
};

/// Accumulates a person's unbalanced moment tick by tick, with inertias of assets/body/segment_inertia.h. Velocities
/// are differences of places, so ticks should be short and the person near the origin.
class BalanceMeter {
 public:
  explicit BalanceMeter(const Body& body);
  /// Adds the pose and the ground reaction after each tick of `tick_s`. The first two give no result.
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
  UnbalancedMoment sums_;  // squares in the place of rms
};

/// One action of people while they walk.
struct BalancedScene {
  std::string_view name;
  UnbalancedMoment moment;
};

/// Runs straight, faster, slower, turning, starting, stopping and limping walks. Errors: a body or style out of range.
std::vector<BalancedScene> walk_balance_scenes(const BodyRequest& body, const GaitStyle& style);

/// Walks until steady, then through one more cycle of the right leg. After each tick calls `row` with the leg's place
/// in the cycle, from heel strike at 0 to the next at 1; from somewhat before to the first tick beyond 1.1. Error: a
/// walk too slow to get there.
void over_steady_cycle(Simulation& simulation, Entity person, const std::function<void(double)>& row);

/// Ground reaction of the right foot in body weights, moments of the right leg in N m/kg, over the right leg's cycle.
struct StrideForces {
  CycleCurve vertical, fore_aft, hip_moment, knee_moment, ankle_moment;
  double mean_weights;  // both feet's vertical force over the stride
};

/// The right leg's cycle. Angles in degrees, heights over the ground in m; percents of the cycle.
struct WalkedStride {
  double height_m, leg_m;  // hip to ground
  double speed_m_s, step_length_m, step_frequency_hz;
  double double_support_cycle;  // one double support as a fraction of the cycle
  CycleCurve hip_from_pelvis, hip_from_vertical, knee, ankle, com_height;
  double com_mean_m, com_lowest_m, com_highest_m;
  /// Times of the lowest and the highest point within a step: 0–50, from either heel strike.
  double com_lowest_percent, com_highest_percent;
  std::optional<StrideForces> forces;  // nothing if not simulated

  /// Returns null if it is not simulated. The hip is measured as the set does.
  const CycleCurve* curve(GaitQuantity quantity, bool from_vertical) const;
};

/// Returns the request with the usual step of people without shoes, as those measured walked.
GaitRequest barefoot(const BodyRequest& body, GaitRequest request);

/// Walks until steady and then one more stride, in ticks of 1/240 s. Errors: a body or gait out of range.
WalkedStride walk_stride(const BodyRequest& body, const GaitRequest& gait);

/// Returns values at every 2 %, from rows of rising cycle phase (in cycles, from at most 0 to at least 1).
CycleCurve sample_cycle(const std::vector<double>& phase, const std::vector<double>& value);

}  // namespace mobil
