#include "demo/compare/compare_findings.h"

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

constexpr std::array<std::span<const PeakWindow>, gait_quantity_count> peak_windows = {
    hip_peaks,      knee_peaks,       ankle_peaks,       vertical_peaks,
    fore_aft_peaks, hip_moment_peaks, knee_moment_peaks, ankle_moment_peaks};

PeakFinding examine_peak(std::span<const CurvePair> pairs, std::size_t own, const PeakWindow& window) {
  PeakFinding finding{window.name, find_peak(*pairs[own].ours, window), {}, {}, 0, 1};
  std::vector<double> measured;
  for (const auto& pair : pairs) {
    const Peak ours = find_peak(*pair.ours, window), theirs = find_peak(pair.measured->mean, window);
    finding.timing.push_back(timing_error(ours.percent, theirs.percent));
    finding.ratio.push_back(ours.value / theirs.value);
    measured.push_back(theirs.value);
  }
  finding.timing_outside = outside_range(finding.timing);
  finding.ratio_outside = ratio_to_range(finding.ours.value, measured);
  return finding;
}

}  // namespace

std::span<const PeakWindow> peaks_of(GaitQuantity quantity) {
  return peak_windows[index(quantity)];
}

std::optional<CurveFinding> examine(const ComparedWalk& walk, const GaitReference& reference, GaitQuantity quantity) {
  std::vector<CurvePair> pairs;
  for (const auto& set : reference.sets) {
    const CycleCurve* ours = walk.stride.curve(quantity, set.hip_from_vertical);
    if (ours == nullptr) return std::nullopt;
    pairs.push_back({ours, &set.curve[walk.speed_class][index(quantity)]});
  }
  CurveFinding finding{};
  for (const auto& pair : pairs) {
    finding.inside.push_back(inside_bands({&pair, 1}));
    finding.rms.push_back(rms_distance(*pair.ours, pair.measured->mean));
    finding.correlation.push_back(correlation(*pair.ours, pair.measured->mean));
  }
  finding.inside_union = inside_bands(pairs);
  finding.rms_nearer_set = std::ranges::min(finding.rms);
  finding.rms_nearer_point = rms_to_nearer_mean(pairs);
  finding.best_correlation = std::ranges::max(finding.correlation);
  for (const auto& window : peaks_of(quantity)) finding.peaks.push_back(examine_peak(pairs, walk.set, window));
  return finding;
}

ExcursionNorm excursion_at(const GaitReference& reference, double speed_m_s) {
  const auto& norms = reference.excursion;
  if (norms.size() < 2) return norms.empty() ? ExcursionNorm{speed_m_s, NAN, NAN} : norms.front();
  std::size_t i = 0;
  while (i + 2 < norms.size() && speed_m_s > norms[i + 1].speed_m_s) ++i;
  const double t = (speed_m_s - norms[i].speed_m_s) / (norms[i + 1].speed_m_s - norms[i].speed_m_s);
  return {speed_m_s, norms[i].mean_m + t * (norms[i + 1].mean_m - norms[i].mean_m),
          norms[i].sd_m + t * (norms[i + 1].sd_m - norms[i].sd_m)};
}

}  // namespace mobil
