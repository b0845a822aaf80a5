#pragma once
// How near a walked curve is to measured ones: pure functions over one gait cycle. The last point of a curve repeats
// the first and is not counted again.

#include <span>
#include <string_view>

#include "demo/pictures/cycle_curve.h"

namespace mobil {

/// Our curve beside one that was measured in the same convention.
struct CurvePair {
  const CycleCurve* ours;
  const MeasuredCurve* measured;
};

/// Share of the cycle, 0 to 1, where ours lies within one standard deviation of at least one of the means.
double inside_bands(std::span<const CurvePair> pairs);

/// Root mean square of ours minus the mean.
double rms_distance(const CycleCurve& ours, const CycleCurve& mean);

/// Root mean square of the distance to whichever mean is nearer at each point.
double rms_to_nearer_mean(std::span<const CurvePair> pairs);

/// Pearson's; 0 where one of the curves is constant.
double correlation(const CycleCurve& a, const CycleCurve& b);

/// The fastest it changes, per cycle: over central differences of 4 %.
double fastest_change(const CycleCurve& curve);

/// Where in the cycle a curve has a peak to be compared, in percent; beyond 100 it goes on into the next cycle.
struct PeakWindow {
  std::string_view name;
  bool maximum;
  int from, to;
};

/// `interior`: a peak indeed and not the end of a slope that runs out of the window.
struct Peak {
  double percent, value;
  bool interior;
};

/// The greatest (or least) value within a window, refined by a parabola through its neighbours.
Peak find_peak(const CycleCurve& curve, const PeakWindow& window);

/// From `reference` to `percent` the shorter way round the cycle, −50 to 50.
double timing_error(double percent, double reference);

/// 0 where the errors lie on both sides of 0, the least otherwise: how far ours is from the range of the references.
double outside_range(std::span<const double> errors);

/// The ratio nearest to 1 that ours has to any value from the least to the greatest of `references` (all of one sign).
double ratio_to_range(double ours, std::span<const double> references);

}  // namespace mobil
