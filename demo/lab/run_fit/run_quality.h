#pragma once
// Distance of a running step from measured ones, and from balance.

#include <optional>

#include "demo/lab/run_fit/run_objective.h"

namespace mobil {

/// A curve against a measured one: angles in degrees, forces in body weights, moments in N m/kg.
struct RunMatch {
  double rms, correlation, within;  // share of the cycle within one deviation
  double max, max_measured, min, min_measured;
};

struct RunQuality {
  std::array<RunMatch, run_compared_count> match;
  /// Unbalanced moments, N m/kg: across and along; about the vertical in flight, and free moment of the foot in stance.
  double pitch_rms, pitch_max, roll_rms, roll_max, yaw_flight_rms, yaw_flight_max, free_rms, free_max;
  double outside_m;            // centre of pressure beyond the sole, where the foot bears over 0.3 of the weight
  double aside_m;              // its greatest distance from the foot's line there
  double flight_force;         // on the 48 segments in flight, body weights
  double rise_m, hips_rms_m;   // rise of the centre of mass; height of the hips against the measured one
  double clearance_m, sink_m;  // least in the middle of the swing, and at all
  double slack_m, pad_max_m, pad_min_m, slide_m;
  double lean_deg, lean_range_deg, side_lean_deg, shoulders_deg, hips_aside_m;
  double error_m;  // of the centre of mass
};

/// Number of intervals of the cycle in judging, a multiple of 200.
inline constexpr std::size_t run_judged_samples = 800;

/// Returns the quality of a shape, judged against measured curves or, without them, against the targets.
RunQuality run_quality(const RunTask& task, const RunTargets& targets, const std::optional<RunMeasured>& measured,
                       const RunShape& shape);

}  // namespace mobil
