#include "demo/lab/compare/compare_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mobil {
namespace {

constexpr std::size_t counted = cycle_points - 1;
constexpr int percent_per_point = 100 / static_cast<int>(counted);

double distance(const CurvePair& pair, std::size_t i) {
  return std::abs((*pair.ours)[i] - pair.measured->mean[i]);
}

}  // namespace

double inside_bands(std::span<const CurvePair> pairs) {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    inside += std::ranges::any_of(pairs, [i](const CurvePair& p) { return distance(p, i) <= p.measured->sd[i]; });
  }
  return static_cast<double>(inside) / counted;
}

double rms_distance(const CycleCurve& ours, const CycleCurve& mean) {
  double sum = 0;
  for (std::size_t i = 0; i < counted; ++i) sum += (ours[i] - mean[i]) * (ours[i] - mean[i]);
  return std::sqrt(sum / counted);
}

double rms_to_nearer_mean(std::span<const CurvePair> pairs) {
  double sum = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& pair : pairs) least = std::min(least, distance(pair, i));
    sum += least * least;
  }
  return std::sqrt(sum / counted);
}

double correlation(const CycleCurve& a, const CycleCurve& b) {
  double mean_a = 0, mean_b = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    mean_a += a[i] / counted;
    mean_b += b[i] / counted;
  }
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

double fastest_change(const CycleCurve& curve) {
  double fastest = 0;
  for (std::size_t i = 0; i < counted; ++i) {
    const double change = curve[(i + 1) % counted] - curve[(i + counted - 1) % counted];
    fastest = std::max(fastest, std::abs(change) * 100 / (2 * percent_per_point));
  }
  return fastest;
}

Peak find_peak(const CycleCurve& curve, const PeakWindow& window) {
  const double sign = window.maximum ? 1 : -1;
  const int first = window.from / percent_per_point, last = window.to / percent_per_point;
  const auto at = [&](int i) {
    const int n = static_cast<int>(counted);
    return sign * curve[static_cast<std::size_t>((i % n + n) % n)];
  };
  int best = first;
  for (int i = first; i <= last; ++i) {
    if (at(i) > at(best)) best = i;
  }
  const double before = at(best - 1), here = at(best), after = at(best + 1);
  const bool interior = before <= here && here >= after;
  const double bend = before - 2 * here + after;
  const double shift = interior && bend < 0 ? 0.5 * (before - after) / bend : 0;
  return {percent_per_point * (best + shift), sign * (here - 0.25 * (before - after) * shift), interior};
}

double timing_error(double percent, double reference) {
  return std::remainder(percent - reference, 100);
}

double outside_range(std::span<const double> errors) {
  if (errors.empty()) return 0;
  const auto [low, high] = std::ranges::minmax(errors);
  if (low <= 0 && high >= 0) return 0;
  return low > 0 ? low : high;
}

double ratio_to_range(double ours, std::span<const double> references) {
  if (references.empty()) return 1;
  const auto [low, high] = std::ranges::minmax(references, {}, [](double v) { return std::abs(v); });
  if (ours * low <= 0) return ours / low;
  if (std::abs(ours) < std::abs(low)) return ours / low;
  return std::abs(ours) > std::abs(high) ? ours / high : 1;
}

}  // namespace mobil
