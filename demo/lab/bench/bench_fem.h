#pragma once
// The parts of `mobil bench fem`. All are on the paper's body, 30 × 30 × 120 mm, with its material and α = 8 1/s.

#include "assets/fem/muscle_template.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"

namespace mobil {

/// CAA, ICD and static on 81 nodes.
Result<void> bench_fem_implicit(BenchRun& run);

}  // namespace mobil
