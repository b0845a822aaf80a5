#pragma once
// The comparison program, mobil_rivals, where it lies beside this one.

#include <map>
#include <string>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil {

/// What one rival said of itself; times are its processor's.
struct RivalTime {
  double us_per_step = 0, median_us = 0, dt_s = 0;
  double far_z_m = 0;  // its first muscle's far face after 248 steps, where it says
  std::string variant, check;
  bool holds = false;
};

/// Whether the comparison program is there.
bool rivals_found();

/// Runs it once for the measurement `name`; `quick`: for a moment, whatever else the machine does. Fails with its own
/// words.
Result<RivalTime> measure_rival(const std::string& name, bool quick);

/// The best of several rounds by the name of the measurement.
class RivalRounds {
 public:
  /// One more round of each of `names`.
  Result<void> add(const std::vector<std::string>& names, bool quick);
  /// Null where it was not measured.
  const RivalTime* find(const std::string& name) const;

 private:
  std::map<std::string, RivalTime> best_;
  std::map<std::string, std::vector<double>> medians_;
};

}  // namespace mobil
