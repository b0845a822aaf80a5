#pragma once
// What every entry of `mobil robustness` is made of: hard cases, each a promise with its bound, and what came of it.
//
// An entry is one function, `void stress_x(StressRun&)`, and one line in the list of stress_command.cpp. It
// adds rows; a row holds where its measured value is on the promised side of its bound, and never where that is
// NaN.

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include "demo/program/must.h"

namespace mobil {

enum class Promise : unsigned char { at_most, at_least };

/// One promise and what came of it.
struct StressRow {
  std::string tried;     // the hard case
  std::string quantity;  // what is held to the bound, with its unit
  Promise promise = Promise::at_most;
  double bound = 0;
  std::string reason;  // of the bound: theory, or the margin over what was measured
  double value = 0;
  std::string detail{};      // further figures, or empty
  std::string_view entry{};  // which of the list it belongs to

  bool held() const { return promise == Promise::at_most ? value <= bound : value >= bound; }
};

/// Keeps the larger of both; NaN stays.
inline void keep_worst(double& worst, double value) {
  if (!(value <= worst) && !std::isnan(worst)) worst = value;
}

struct StressRun {
  bool quick = false;
  std::vector<StressRow> rows;
  void (*show)(std::string_view entry, double part) = [](std::string_view, double) {};  // progress, part 0–1
  std::string_view entry;                                                               // being run

  /// Adds a row: `value`, of a quantity with its unit, is at most (at least) `bound`.
  void at_most(std::string tried, std::string quantity, double bound, double value, std::string reason,
               std::string detail = {});
  void at_least(std::string tried, std::string quantity, double bound, double value, std::string reason,
                std::string detail = {});
  void progress(double part) const { show(entry, part); }
};

void stress_slivers(StressRun& run);
void stress_aspect(StressRun& run);
void stress_inverted(StressRun& run);
void stress_poisson(StressRun& run);
void stress_young(StressRun& run);
void stress_damping(StressRun& run);
void stress_steps(StressRun& run);
void stress_caa(StressRun& run);
void stress_step_load(StressRun& run);
void stress_resonance(StressRun& run);
void stress_energy_single(StressRun& run);
void stress_denormals(StressRun& run);
void stress_nan(StressRun& run);
void stress_explosion(StressRun& run);
void stress_excitation(StressRun& run);
void stress_contraction(StressRun& run);
void stress_walkers(StressRun& run);
void stress_ways(StressRun& run);
void stress_relevance(StressRun& run);
void stress_ticks(StressRun& run);
void stress_far(StressRun& run);
void stress_day(StressRun& run);

}  // namespace mobil
