#pragma once
// Findings of a comparison (one walk, one quantity, every measured set), the bounds of a walk, and the verdicts on
// them; both in words and as JSON.

#include <span>

#include "demo/lab/compare/compare_walk.h"

namespace mobil {

/// A stride at the speed of one class of one set.
struct ComparedWalk {
  std::size_t set, speed_class;  // into GaitReference
  double speed_m_s;
  WalkedStride stride;
};

/// One peak of ours compared with each set's. `timing`: delay of ours, in percent of the cycle. `ratio`: ours over the
/// set's, moments scaled to our leg. `ratio_printed`: over the set's as it was published.
struct PeakFinding {
  std::string_view name;
  Peak ours;
  std::vector<double> timing, ratio, ratio_printed;
  double timing_outside;  // relative to the range of the sets, 0 inside
  double ratio_outside;   // relative to the nearest value of that range, 1 inside
  double size_outside;    // difference from that value over it, or over the smallest that counts (moments: 0.2 N m/kg)
};

/// Findings. Vectors have one entry for each set with the speed class (listed in `set`), in its own convention.
struct CurveFinding {
  std::vector<std::size_t> set;
  std::vector<double> inside, rms, correlation;
  double rate_ratio;  // our fastest change over the fastest of the sets'
  double inside_union, rms_nearer_set, rms_nearer_point, best_correlation;
  std::vector<PeakFinding> peaks;
};

/// Returns the peaks that are compared, in order of time.
std::span<const PeakWindow> peaks_of(GaitQuantity quantity);

/// Compares a walk with the curves of its speed class in every set; returns nothing if the quantity is not simulated.
std::optional<CurveFinding> examine(const ComparedWalk& walk, const GaitReference& reference, GaitQuantity quantity);

/// Returns the excursion of the centre of mass at a speed, between the two nearest norms; beyond the slowest and the
/// fastest, theirs.
ExcursionNorm excursion_at(const GaitReference& reference, double speed_m_s);

/// Returns the excursion of a person with such a leg who walks alike.
ExcursionNorm excursion_of(const GaitReference& reference, const WalkedStride& stride);

/// A stride with a varied body or gait: step lengths, heights, masses.
struct VariedWalk {
  double value;  // the varied quantity
  WalkedStride stride;
};

struct Comparison {
  BodyRequest body;
  GaitReference reference;
  std::vector<ComparedWalk> walks;
  std::vector<VariedWalk> by_speed;        // m/s, the requested body
  std::vector<VariedWalk> by_height;       // m, at one speed, build unchanged
  std::vector<VariedWalk> by_step_length;  // m, at one speed
  std::vector<VariedWalk> by_mass;         // kg, at one speed
  std::vector<BalancedScene> balance;      // the requested body
};

/// One bound. `held` is absent if the quantity is not simulated; `unit` is "1" for pure numbers.
struct Verdict {
  std::string what, unit, bound;
  double value;
  std::optional<bool> held;
};

/// Returns the maximum difference of joint angles from the nearer mean, root mean square, degrees; more at the slowest
/// and the fastest speed.
constexpr double angle_rms_bound_deg(std::size_t speed_class) {
  return speed_class == compared_class::very_slow || speed_class == compared_class::very_fast ? 4 : 3;
}
/// Maximum speed of hip, knee and ankle relative to the fastest measured.
inline constexpr double rate_bound[] = {1.2, 1.2, 1.5};
/// Maximum unbalanced moment, N m/kg.
inline constexpr double balance_bound = 0.02;

/// Returns every bound over all walks. Several sets count by the union of their bands, the nearer of their means, the
/// range of their peaks.
std::vector<Verdict> judge(const Comparison& comparison);

/// Returns, for example, "slow 0.87 m/s (Schwartz 2008)".
std::string walk_name(const Comparison& comparison, const ComparedWalk& walk);

/// Returns steps of a walk in the units of a StepNorm.
StepNorm step_of(const WalkedStride& stride);

/// Returns the distance of the step length (or cadence), in deviations, from the nearest of the bands, each ± one
/// deviation; 0 inside one; nothing if no band reaches that speed.
std::optional<double> outside_step_bands(const GaitReference& reference, const StepNorm& step, bool cadence);

/// Returns a line for each walk and quantity, then the bounds that did not hold.
std::string comparison_text(const Comparison& comparison, const std::vector<Verdict>& verdicts);

/// Returns the whole of compare.json: body, walks with every finding and curve, variations, verdicts.
std::string comparison_json(const Comparison& comparison, const std::vector<Verdict>& verdicts);

}  // namespace mobil
