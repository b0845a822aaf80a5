#pragma once
// `mobil frontier --finite`, its second part: how far bellies that a jolt shakes are from the motion of tissue at
// finite strain whose fibres pull.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "components/muscle.h"
#include "engine/error.h"

namespace mobil {

/// What a jolt adds to where control points are, of one way to move them: off the reference's, over all that this has,
/// root of the mean square; and at worst, m.
struct ShakenError {
  std::string way;
  double all = 0, across = 0, worst_m = 0;
};

struct ShakenFrontier {
  std::string muscle;              // the last: "all" together
  double all_m = 0, across_m = 0;  // what the jolt adds, root of the mean square
  std::vector<ShakenError> ways;
};

/// These rows of the muscle table on 4x4x16 cells; some seconds each. `progress`: 0 to 1.
Result<std::vector<ShakenFrontier>> measure_shaken(std::span<const Muscle> rows,
                                                   void (*progress)(std::string_view what, double part));

std::string shaken_text(const std::vector<ShakenFrontier>& muscles);
std::string shaken_csv(const std::vector<ShakenFrontier>& muscles);

}  // namespace mobil
