#pragma once
// The parts of `mobil bench fem`. All are on the paper's body, 30 × 30 × 120 mm, with its material and α = 8 1/s.

#include "assets/fem/muscle_template.h"
#include "demo/lab/bench/bench.h"
#include "demo/lab/bench/bench_fem_bellies.h"

namespace mobil {

/// Adds the time of one muscle's step from that of `steps` steps of `muscles`, and its share of the peak.
BenchResult& add_step_time(BenchRun& run, const std::string& stem, const Measured& time, double muscles, double steps,
                           const Cells& cells);

/// ECD on 99, 425, 525, 2673 and 3321 nodes.
Result<void> bench_fem_meshes(BenchRun& run);
/// CAA, ICD and static on 81 nodes.
Result<void> bench_fem_implicit(BenchRun& run);

}  // namespace mobil
