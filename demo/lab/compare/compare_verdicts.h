#pragma once
// Findings of a comparison (one walk, one quantity, every measured set), the bounds that a walk is held to, and
// whether it keeps them; both in words and as JSON.

#include <span>

#include "demo/lab/compare/compare_walk.h"

namespace mobil {

/// A stride at the speed of one class of one set.
struct ComparedWalk {
  std::size_t set, speed_class;  // into GaitReference
  double speed_m_s;
  WalkedStride stride;
};

/// One peak of ours against each set's. `timing`: ours later, in percent of the cycle; `ratio`: ours over the set's,
/// moments scaled to our leg; `ratio_printed`: over the set's as it was published.
struct PeakFinding {
  std::string_view name;
  Peak ours;
  std::vector<double> timing, ratio, ratio_printed;
  double timing_outside;  // from the range of the sets, 0 inside
  double ratio_outside;   // to the nearest value of that range, 1 inside
  double size_outside;  // from that value, as a part of it or of the least that counts (moments: 0.2 N m/kg); 0 inside
};

/// Vectors: one entry for each set that has the speed class (their numbers in `set`), each in its own convention.
struct CurveFinding {
  std::vector<std::size_t> set;
  std::vector<double> inside, rms, correlation;
  double rate_ratio;  // our fastest change over the fastest of the sets'
  double inside_union, rms_nearer_set, rms_nearer_point, best_correlation;
  std::vector<PeakFinding> peaks;
};

/// The peaks that are compared, in order of time.
std::span<const PeakWindow> peaks_of(GaitQuantity quantity);

/// Against the curves of that speed class of every set; nothing where the quantity is not simulated.
std::optional<CurveFinding> examine(const ComparedWalk& walk, const GaitReference& reference, GaitQuantity quantity);

/// The excursion of the centre of mass at a speed, between the two nearest norms; beyond the slowest and
/// the fastest, theirs.
ExcursionNorm excursion_at(const GaitReference& reference, double speed_m_s);

/// A stride of a body or gait that was varied: for step lengths, heights, masses.
struct VariedWalk {
  double value;  // what is varied
  WalkedStride stride;
};

struct Comparison {
  BodyRequest body;
  GaitReference reference;
  std::vector<ComparedWalk> walks;
  std::vector<VariedWalk> by_speed;        // m/s, the body asked for
  std::vector<VariedWalk> by_height;       // m, at one speed, build unchanged
  std::vector<VariedWalk> by_step_length;  // m, at one speed
  std::vector<VariedWalk> by_mass;         // kg, at one speed
  std::vector<BalancedScene> balance;      // the body asked for
};

/// One bound. `held` is absent where the quantity is not simulated; `unit` is "1" where there is none.
struct Verdict {
  std::string what, unit, bound;
  double value;
  std::optional<bool> held;
};

/// Most that joint angles may differ from the nearer mean, root mean square: degrees, more at the slowest and the
/// fastest speed.
constexpr double angle_rms_bound_deg(std::size_t speed_class) {
  return speed_class == compared_class::very_slow || speed_class == compared_class::very_fast ? 4 : 3;
}
/// Most that hip, knee and ankle may turn faster than the fastest measured.
inline constexpr double rate_bound[] = {1.2, 1.2, 1.5};
/// Most that the unbalanced moment may be, N m/kg.
inline constexpr double balance_bound = 0.02;

/// Every bound over all walks. Where there are several sets: the union of their bands, the nearer of their means, the
/// range of their peaks.
std::vector<Verdict> judge(const Comparison& comparison);

/// "slow 0.87 m/s (Schwartz 2008)".
std::string walk_name(const Comparison& comparison, const ComparedWalk& walk);

/// Steps of a walk in the units of a StepNorm.
StepNorm step_of(const WalkedStride& stride);

/// By how many deviations the step length (or cadence) lies outside the nearest of the bands, each ± one deviation; 0
/// inside one; nothing where no band reaches that speed.
std::optional<double> outside_step_bands(const GaitReference& reference, const StepNorm& step, bool cadence);

/// A line a walk and quantity, then the bounds that did not hold.
std::string comparison_text(const Comparison& comparison, const std::vector<Verdict>& verdicts);

/// The whole of compare.json: body, walks with every finding and curve, variations, verdicts.
std::string comparison_json(const Comparison& comparison, const std::vector<Verdict>& verdicts);

}  // namespace mobil
