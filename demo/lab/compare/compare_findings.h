#pragma once
// What comparison finds, before it is judged: one walk, one quantity, every measured set.

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "demo/lab/compare/compare_reference.h"
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

}  // namespace mobil
