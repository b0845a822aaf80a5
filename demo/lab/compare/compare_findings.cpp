#include "demo/lab/compare/compare_findings.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mobil {
namespace {

constexpr PeakWindow hip_peaks[] = {{"extension", false, 30, 74}, {"flexion", true, 70, 104}};
constexpr PeakWindow knee_peaks[] = {{"stance flexion", true, 4, 32}, {"swing flexion", true, 50, 90}};
constexpr PeakWindow ankle_peaks[] = {{"dorsiflexion", true, 24, 58}, {"plantarflexion", false, 50, 80}};
constexpr PeakWindow vertical_peaks[] = {
    {"first hump", true, 4, 32}, {"valley", false, 20, 44}, {"second hump", true, 36, 60}};
constexpr PeakWindow fore_aft_peaks[] = {{"braking", false, 2, 32}, {"propulsion", true, 36, 64}};
constexpr PeakWindow hip_moment_peaks[] = {{"extensor", true, 0, 30}, {"flexor", false, 30, 66}};
constexpr PeakWindow knee_moment_peaks[] = {{"extensor", true, 6, 30}};
constexpr PeakWindow ankle_moment_peaks[] = {{"plantarflexor", true, 30, 60}};

/// Peaks near zero are not judged by their ratio: N m/kg.
constexpr double least_moment_peak = 0.2;

constexpr std::array<std::span<const PeakWindow>, gait_quantity_count> peak_windows = {
    hip_peaks,      knee_peaks,       ankle_peaks,       vertical_peaks,
    fore_aft_peaks, hip_moment_peaks, knee_moment_peaks, ankle_moment_peaks};

/// `own`: which of the pairs is of the set that walks; `scale`: how much each measured curve was scaled.
PeakFinding examine_peak(std::span<const CurvePair> pairs, std::size_t own, const PeakWindow& window,
                         std::span<const double> scale, double least) {
  PeakFinding finding{window.name, find_peak(*pairs[own].ours, window), {}, {}, {}, 0, 1, 0};
  std::vector<double> measured;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const CurvePair& pair = pairs[i];
    const Peak ours = find_peak(*pair.ours, window), theirs = find_peak(pair.measured->mean, window);
    finding.timing.push_back(timing_error(ours.percent, theirs.percent));
    finding.ratio.push_back(ours.value / theirs.value);
    finding.ratio_printed.push_back(scale[i] * ours.value / theirs.value);
    measured.push_back(theirs.value);
  }
  finding.timing_outside = outside_range(finding.timing);
  finding.ratio_outside = ratio_to_range(finding.ours.value, measured);
  if (finding.ratio_outside != 1) {
    const double nearest = finding.ours.value / finding.ratio_outside;
    finding.size_outside = (finding.ours.value - nearest) / std::max(std::abs(nearest), least);
  }
  return finding;
}

}  // namespace

std::span<const PeakWindow> peaks_of(GaitQuantity quantity) {
  return peak_windows[index(quantity)];
}

std::optional<CurveFinding> examine(const ComparedWalk& walk, const GaitReference& reference, GaitQuantity quantity) {
  CurveFinding finding{};
  std::vector<MeasuredCurve> measured;
  for (std::size_t s = 0; s < reference.sets.size(); ++s) {
    if (!reference.sets[s].measured[walk.speed_class]) continue;
    finding.set.push_back(s);
    measured.push_back(reference.sets[s].scaled(walk.speed_class, quantity, walk.stride.leg_m));
  }
  std::vector<CurvePair> pairs;
  std::vector<double> scale;
  for (std::size_t i = 0; i < finding.set.size(); ++i) {
    const MeasuredSet& set = reference.sets[finding.set[i]];
    const CycleCurve* ours = walk.stride.curve(quantity, set.hip_from_vertical);
    if (ours == nullptr) return std::nullopt;
    pairs.push_back({ours, &measured[i]});
    scale.push_back(is_moment(quantity) ? walk.stride.leg_m / set.leg_m : 1);
  }
  double fastest = 0;
  for (const auto& pair : pairs) {
    fastest = std::max(fastest, fastest_change(pair.measured->mean));
    finding.inside.push_back(inside_bands({&pair, 1}));
    finding.rms.push_back(rms_distance(*pair.ours, pair.measured->mean));
    finding.correlation.push_back(correlation(*pair.ours, pair.measured->mean));
  }
  finding.inside_union = inside_bands(pairs);
  finding.rms_nearer_set = std::ranges::min(finding.rms);
  finding.rms_nearer_point = rms_to_nearer_mean(pairs);
  finding.best_correlation = std::ranges::max(finding.correlation);
  const auto own = static_cast<std::size_t>(std::ranges::find(finding.set, walk.set) - finding.set.begin());
  finding.rate_ratio = fastest_change(*pairs[own].ours) / fastest;
  const double least = is_moment(quantity) ? least_moment_peak : 0;
  for (const auto& window : peaks_of(quantity)) finding.peaks.push_back(examine_peak(pairs, own, window, scale, least));
  return finding;
}

ExcursionNorm excursion_at(const GaitReference& reference, double speed_m_s) {
  const auto& norms = reference.excursion;
  if (norms.size() < 2) return norms.empty() ? ExcursionNorm{speed_m_s, NAN, NAN} : norms.front();
  const double speed = std::clamp(speed_m_s, norms.front().speed_m_s, norms.back().speed_m_s);
  std::size_t i = 0;
  while (i + 2 < norms.size() && speed > norms[i + 1].speed_m_s) ++i;
  const double t = (speed - norms[i].speed_m_s) / (norms[i + 1].speed_m_s - norms[i].speed_m_s);
  return {speed_m_s, norms[i].mean_m + t * (norms[i + 1].mean_m - norms[i].mean_m),
          norms[i].sd_m + t * (norms[i + 1].sd_m - norms[i].sd_m)};
}

}  // namespace mobil
