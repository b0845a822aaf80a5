#pragma once
// Common parts of all entries of `mobil robustness`: hard cases, each with a promise, its bound and the result.
//
// An entry is one function, `void robustness_x(RobustnessRun&)`, and one line in the list of robustness_command.cpp. It
// adds rows. A row holds if its measured value is on the promised side of its bound; NaN never holds.

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include "demo/program/must.h"

namespace mobil {

enum class Promise : unsigned char { at_most, at_least };

/// One promise and its result.
struct RobustnessRow {
  std::string tried;     // the hard case
  std::string quantity;  // quantity with a bound, and its unit
  Promise promise = Promise::at_most;
  double bound = 0;
  std::string reason;  // of the bound: theory, or the margin over the measured value
  double value = 0;
  std::string detail{};      // further figures, or empty
  std::string_view entry{};  // its entry in the list

  bool held() const { return promise == Promise::at_most ? value <= bound : value >= bound; }
};

/// Keeps the larger of both; NaN is kept.
inline void keep_worst(double& worst, double value) {
  if (!(value <= worst) && !std::isnan(worst)) worst = value;
}

struct RobustnessRun {
  bool quick = false;
  std::vector<RobustnessRow> rows;
  void (*show)(std::string_view entry, double part) = [](std::string_view, double) {};  // progress, part 0–1
  std::string_view entry;                                                               // being run

  /// Adds a row: `value`, of a quantity with its unit, is at most (at least) `bound`.
  void at_most(std::string tried, std::string quantity, double bound, double value, std::string reason,
               std::string detail = {});
  void at_least(std::string tried, std::string quantity, double bound, double value, std::string reason,
                std::string detail = {});
  void progress(double part) const { show(entry, part); }
};

void robustness_slivers(RobustnessRun& run);
void robustness_aspect(RobustnessRun& run);
void robustness_inverted(RobustnessRun& run);
void robustness_poisson(RobustnessRun& run);
void robustness_young(RobustnessRun& run);
void robustness_damping(RobustnessRun& run);
void robustness_steps(RobustnessRun& run);
void robustness_newmark(RobustnessRun& run);
void robustness_step_load(RobustnessRun& run);
void robustness_resonance(RobustnessRun& run);
void robustness_energy_single(RobustnessRun& run);
void robustness_denormals(RobustnessRun& run);
void robustness_nan(RobustnessRun& run);
void robustness_explosion(RobustnessRun& run);
void robustness_excitation(RobustnessRun& run);
void robustness_contraction(RobustnessRun& run);
void robustness_walkers(RobustnessRun& run);
void robustness_ways(RobustnessRun& run);
void robustness_lod(RobustnessRun& run);
void robustness_ticks(RobustnessRun& run);
void robustness_far(RobustnessRun& run);
void robustness_day(RobustnessRun& run);

}  // namespace mobil
