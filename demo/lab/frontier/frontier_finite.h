#pragma once
// `mobil frontier --finite`: how far what is shown is from tissue at finite strain.

#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>

namespace mobil {

/// One way to show muscles, held against nonlinear statics of each row of the muscle table.
struct FiniteError {
  std::string way;
  /// Displacement across of the control points off, of a shape's own: root of the mean square over all shapes, and the
  /// worst; the farthest point off, m; and the volume they enclose off that at rest, at worst.
  double rms = 0, worst = 0, farthest_m = 0, volume = 0;
};

struct FiniteFrontier {
  std::string muscle;  // the last: "all" together
  std::vector<FiniteError> ways;
};

/// Shortenings and activations that the tables were not made from; a minute. `progress`: 0 to 1.
Result<std::vector<FiniteFrontier>> measure_finite(void (*progress)(std::string_view what, double part));

std::string finite_text(const std::vector<FiniteFrontier>& muscles);
std::string finite_csv(const std::vector<FiniteFrontier>& muscles);

}  // namespace mobil
