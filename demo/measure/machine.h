#pragma once
// Description of this machine, with its measured peak arithmetic and memory rates.

#include <cstddef>
#include <string>

namespace mobil {

class Json;  // demo/program/json.h

/// Properties that the machine reports; sizes in bytes, 0 if not reported.
struct Machine {
  std::string cpu, target, compiler, flags;  // `target`: instruction set of the kernels
  unsigned cores = 1;
  std::size_t l1_bytes = 0, l2_bytes = 0, l3_bytes = 0;

  // Measured; 0 until `measure_machine`.
  double clock_ghz = 0;  // of one busy core, by a chain of dependent additions
  /// Single precision, one core; a fused multiply-add is two operations.
  double fma_peak_gflops = 0, fma_peak_median_gflops = 0;
  /// Rate of a = b + s·c over arrays larger than the caches, three numbers per step (the cache's fetch before a write
  /// is not counted). For one core, and for all cores at the same time.
  double bandwidth_gbps = 0, bandwidth_median_gbps = 0;
  double all_cores_bandwidth_gbps = 0, all_cores_bandwidth_median_gbps = 0;
};

/// Returns the reported properties; measures nothing.
Machine describe_machine();

/// Returns processor, cores, instruction set, compiler and flags, for results.
Json machine_json(const Machine& machine);

/// Measures the rates. Takes about a second and memory of four times the last-level cache (192 MB to 1.2 GB).
void measure_machine(Machine& machine);

}  // namespace mobil
