#include "demo/lab/compare/compare_verdicts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

/// Minimum size of peaks that are judged by their ratio, N m/kg.
constexpr double min_moment_peak = 0.2;

constexpr std::array<std::span<const PeakWindow>, gait_quantity_count> peak_windows = {
    hip_peaks,      knee_peaks,       ankle_peaks,       vertical_peaks,
    fore_aft_peaks, hip_moment_peaks, knee_moment_peaks, ankle_moment_peaks};

/// `own` is the pair of the set that walks; `scale` contains the factor of each measured curve.
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

constexpr GaitQuantity angle_quantities[] = {GaitQuantity::hip, GaitQuantity::knee, GaitQuantity::ankle};
constexpr GaitQuantity moment_quantities[] = {GaitQuantity::hip_moment, GaitQuantity::knee_moment,
                                              GaitQuantity::ankle_moment};
constexpr double inside_bound = 0.9, timing_bound_percent = 3;
constexpr double ground_peak_bound = 0.10, moment_peak_bound = 0.20, weight_bound = 0.01;
constexpr double vertical_correlation_bound = 0.98, fore_aft_correlation_bound = 0.95, correlation_bound = 0.9;

class Verdicts {
 public:
  void at_most(std::string what, double value, double bound, std::string_view unit) {
    all.push_back({std::move(what), std::string(unit), fmt::format("at most {:g}", bound), value, value <= bound});
  }
  void at_least(std::string what, double value, double bound, std::string_view unit) {
    all.push_back({std::move(what), std::string(unit), fmt::format("at least {:g}", bound), value, value >= bound});
  }
  void within(std::string what, double value, double low, double high, std::string_view unit) {
    all.push_back({std::move(what), std::string(unit), fmt::format("{:.4g} to {:.4g}", low, high), value,
                   value >= low && value <= high});
  }
  void not_simulated(std::string what) { all.push_back({std::move(what), "1", "not simulated", NAN, std::nullopt}); }

  std::vector<Verdict> all;
};

/// Returns the largest difference of a peak's size from the references', as a share of them.
double worst_size(const CurveFinding& finding) {
  double worst = 0;
  for (const auto& peak : finding.peaks) {
    if (peak.name != "valley") worst = std::max(worst, std::abs(peak.size_outside));
  }
  return worst;
}

double worst_timing(const CurveFinding& finding) {
  double worst = 0;
  for (const auto& peak : finding.peaks) worst = std::max(worst, std::abs(peak.timing_outside));
  return worst;
}

/// Returns the height of the lower hump over the valley between; negative without two humps.
double humps(const CurveFinding& vertical) {
  const Peak &first = vertical.peaks[0].ours, &valley = vertical.peaks[1].ours, &second = vertical.peaks[2].ours;
  if (!first.interior || !valley.interior || !second.interior) return -1;
  return std::min(first.value, second.value) - valley.value;
}

void judge_angles(const Comparison& comparison, const ComparedWalk& walk, const std::string& name, Verdicts& verdicts) {
  for (std::size_t i = 0; i < std::size(angle_quantities); ++i) {
    const auto finding = examine(walk, comparison.reference, angle_quantities[i]);
    const std::string of = fmt::format("{}: {} ", name, gait_quantity_name[index(angle_quantities[i])]);
    verdicts.at_least(of + "inside the band, share of the cycle", finding->inside_union, inside_bound, "1");
    verdicts.at_most(of + "rms from the nearer mean", finding->rms_nearer_set, angle_rms_bound_deg(walk.speed_class),
                     "deg");
    verdicts.at_most(of + "peaks off in time", worst_timing(*finding), timing_bound_percent, "% of the cycle");
    verdicts.at_most(of + "fastest, of the fastest measured", finding->rate_ratio, rate_bound[i], "1");
  }
}

void judge_ground_reaction(const Comparison& comparison, const ComparedWalk& walk, const std::string& name,
                           Verdicts& verdicts) {
  const auto vertical = examine(walk, comparison.reference, GaitQuantity::vertical);
  const auto fore_aft = examine(walk, comparison.reference, GaitQuantity::fore_aft);
  verdicts.at_least(name + ": humps of the vertical force over its valley", humps(*vertical), 0.005, "body weights");
  verdicts.at_most(name + ": humps off in size, share", worst_size(*vertical), ground_peak_bound, "1");
  verdicts.at_least(name + ": vertical force, correlation", vertical->best_correlation, vertical_correlation_bound,
                    "1");
  verdicts.at_most(name + ": fore-aft peaks off in size, share", worst_size(*fore_aft), ground_peak_bound, "1");
  verdicts.at_least(name + ": fore-aft force, correlation", fore_aft->best_correlation, fore_aft_correlation_bound,
                    "1");
  verdicts.within(name + ": mean vertical force of both feet", walk.stride.forces->mean_weights, 1 - weight_bound,
                  1 + weight_bound, "body weights");
}

void judge_forces(const Comparison& comparison, const ComparedWalk& walk, const std::string& name, Verdicts& verdicts) {
  if (!walk.stride.forces) {
    verdicts.not_simulated(name + ": ground reaction");
    verdicts.not_simulated(name + ": joint moments");
    return;
  }
  if (comparison.reference.sets[walk.set].measured[walk.speed_class][index(GaitQuantity::vertical)])
    judge_ground_reaction(comparison, walk, name, verdicts);
  for (const auto quantity : moment_quantities) {
    const auto finding = examine(walk, comparison.reference, quantity);
    const std::string of = fmt::format("{}: {}, ", name, gait_quantity_name[index(quantity)]);
    verdicts.at_least(of + "correlation", finding->best_correlation, correlation_bound, "1");
    verdicts.at_most(of + "peaks off in size, share", worst_size(*finding), moment_peak_bound, "1");
  }
}

/// Bounds: highest in the middle half of single support, lowest in double support; excursion within one deviation.
void judge_centre_of_mass(const Comparison& comparison, const ComparedWalk& walk, const std::string& name,
                          Verdicts& verdicts) {
  const double double_support = 100 * walk.stride.double_support_cycle;
  const double quarter = (50 - double_support) / 4;
  verdicts.within(name + ": centre of mass highest", walk.stride.com_highest_percent, double_support + quarter,
                  50 - quarter, "% of the cycle");
  // signed, because a little before heel strike is not yet double support
  const double lowest = walk.stride.com_lowest_percent;
  verdicts.within(name + ": centre of mass lowest", lowest > 49.5 ? lowest - 50 : lowest, -0.5, double_support,
                  "% of the cycle");
  const auto norm = excursion_of(comparison.reference, walk.stride);
  verdicts.within(name + ": centre of mass, excursion", 1000 * (walk.stride.com_highest_m - walk.stride.com_lowest_m),
                  1000 * (norm.mean_m - norm.sd_m), 1000 * (norm.mean_m + norm.sd_m), "mm");
}

void judge_steps(const GaitReference& reference, const std::vector<VariedWalk>& walks, const std::string& against,
                 Verdicts& verdicts) {
  for (const bool cadence : {false, true}) {
    double worst = 0;
    for (const auto& walk : walks) {
      worst = std::max(worst, outside_step_bands(reference, step_of(walk.stride), cadence).value_or(0));
    }
    verdicts.at_most(fmt::format("{} against {}: farthest outside the published spread",
                                 cadence ? "cadence" : "step length", against),
                     worst, 0, "standard deviations");
  }
}

/// Returns the smallest decrease of `height` from one walk to the next; positive if all decrease.
template <class Height>
double min_drop(const std::vector<VariedWalk>& walks, Height height) {
  double least = walks.size() < 2 ? 0 : INFINITY;
  for (std::size_t i = 1; i < walks.size(); ++i) {
    least = std::min(least, height(walks[i - 1].stride) - height(walks[i].stride));
  }
  return 1000 * least;
}

}  // namespace

std::span<const PeakWindow> peaks_of(GaitQuantity quantity) {
  return peak_windows[index(quantity)];
}

std::optional<CurveFinding> examine(const ComparedWalk& walk, const GaitReference& reference, GaitQuantity quantity) {
  CurveFinding finding{};
  std::vector<MeasuredCurve> measured;
  for (std::size_t s = 0; s < reference.sets.size(); ++s) {
    if (!reference.sets[s].measured[walk.speed_class][index(quantity)]) continue;
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
  auto own = static_cast<std::size_t>(std::ranges::find(finding.set, walk.set) - finding.set.begin());
  if (own == finding.set.size()) own = 0;  // measured at that speed by others
  finding.rate_ratio = fastest_change(*pairs[own].ours) / fastest;
  const double least = is_moment(quantity) ? min_moment_peak : 0;
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

ExcursionNorm excursion_of(const GaitReference& reference, const WalkedStride& stride) {
  const double ratio = stride.leg_m / reference.excursion_leg_m;
  const ExcursionNorm norm = excursion_at(reference, stride.speed_m_s / std::sqrt(ratio));
  return {stride.speed_m_s, ratio * norm.mean_m, ratio * norm.sd_m};
}

std::string walk_name(const Comparison& comparison, const ComparedWalk& walk) {
  return fmt::format("{} {:.2f} m/s ({})", compared_class_name[walk.speed_class], walk.speed_m_s,
                     comparison.reference.sets[walk.set].name);
}

StepNorm step_of(const WalkedStride& stride) {
  return {stride.speed_m_s / std::sqrt(gravity_m_s2 * stride.height_m), stride.step_length_m / stride.height_m, 0,
          stride.step_frequency_hz * std::sqrt(stride.height_m / gravity_m_s2), 0};
}

std::optional<double> outside_step_bands(const GaitReference& reference, const StepNorm& step, bool cadence) {
  std::optional<double> nearest;
  for (const auto& band : reference.steps) {
    const auto norm = band.at(step.speed);
    if (!norm) continue;
    const double off = cadence ? std::abs(step.cadence - norm->cadence) / norm->cadence_sd
                               : std::abs(step.length - norm->length) / norm->length_sd;
    nearest = std::min(nearest.value_or(INFINITY), std::max(off - 1, 0.0));
  }
  return nearest;
}

std::vector<Verdict> judge(const Comparison& comparison) {
  Verdicts verdicts;
  for (const auto& walk : comparison.walks) {
    const std::string name = walk_name(comparison, walk);
    judge_angles(comparison, walk, name, verdicts);
    judge_forces(comparison, walk, name, verdicts);
    judge_centre_of_mass(comparison, walk, name, verdicts);
  }
  for (const auto& scene : comparison.balance) {
    const std::string of = fmt::format("{}: unbalanced moment, ", scene.name);
    verdicts.at_most(of + "pitch, rms", scene.moment.pitch_rms, balance_bound, "N m/kg");
    verdicts.at_most(of + "roll, rms", scene.moment.roll_rms, balance_bound, "N m/kg");
  }
  judge_steps(comparison.reference, comparison.by_speed, "speed", verdicts);
  judge_steps(comparison.reference, comparison.by_height, "height", verdicts);
  const auto lowest = [](const WalkedStride& stride) { return stride.com_lowest_m; };
  const auto highest = [](const WalkedStride& stride) { return stride.com_highest_m; };
  const auto mean = [](const WalkedStride& stride) { return stride.com_mean_m; };
  verdicts.at_least("longer steps: least drop of the centre of mass's lowest point",
                    min_drop(comparison.by_step_length, lowest), 0.1, "mm");
  std::string masses;
  for (const VariedWalk& walk : comparison.by_mass)
    masses += fmt::format("{}{:.0f}", masses.empty() ? "" : ", ", walk.value);
  verdicts.at_least(masses + " kg: least drop of the centre of mass's mean height", min_drop(comparison.by_mass, mean),
                    0.1, "mm");
  verdicts.at_least(masses + " kg: least drop of the centre of mass's highest point",
                    min_drop(comparison.by_mass, highest), 0.1, "mm");
  return std::move(verdicts.all);
}

}  // namespace mobil
