#pragma once
// Distance of a walked curve from measured ones: pure functions over one gait cycle. The last point of a curve repeats
// the first and is not counted again.

#include <span>
#include <string_view>

#include "demo/pictures/cycle_curve.h"

namespace mobil {

/// Our curve, and one that was measured in the same convention.
struct CurvePair {
  const CycleCurve* ours;
  const MeasuredCurve* measured;
};

/// Returns the share of the cycle, 0 to 1, in which ours is within one standard deviation of at least one of the means.
double inside_bands(std::span<const CurvePair> pairs);

/// Returns the root mean square of ours minus the mean.
double rms_distance(const CycleCurve& ours, const CycleCurve& mean);

/// Returns the root mean square of the distance to the nearer mean at each point.
double rms_to_nearer_mean(std::span<const CurvePair> pairs);

/// Returns Pearson's correlation; 0 if one of the curves is constant.
double correlation(const CycleCurve& a, const CycleCurve& b);

/// Returns the fastest change, per cycle, over central differences of 4 %.
double fastest_change(const CycleCurve& curve);

/// Part of the cycle, in percent, in which a curve has a peak to compare; beyond 100 it is in the next cycle.
struct PeakWindow {
  std::string_view name;
  bool maximum;
  int from, to;
};

/// `interior` is true for a real peak, false for the end of a slope that leaves the window.
struct Peak {
  double percent, value;
  bool interior;
};

/// Returns the maximum (or minimum) within a window, refined by a parabola through its neighbours.
Peak find_peak(const CycleCurve& curve, const PeakWindow& window);

/// Returns the difference from `reference` to `percent`, the shorter way around the cycle, −50 to 50.
double timing_error(double percent, double reference);

/// Returns the distance of ours from the range of the references: 0 if the errors have both signs, else the smallest.
double outside_range(std::span<const double> errors);

/// Returns the ratio nearest to 1 of ours to any value in the range of `references` (all of one sign).
double ratio_to_range(double ours, std::span<const double> references);

}  // namespace mobil
