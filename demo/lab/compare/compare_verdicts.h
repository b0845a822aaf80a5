#pragma once
// The bounds that a walk is held to, and whether it keeps them.

#include <optional>
#include <string>
#include <vector>

#include "demo/lab/compare/compare_balance.h"
#include "demo/lab/compare/compare_findings.h"

namespace mobil {

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

}  // namespace mobil
