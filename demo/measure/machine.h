#pragma once
// What this machine is, and the most that one core and its memory can do.

#include <cstddef>
#include <string>

namespace mobil {

class Json;  // demo/program/json.h

/// What the machine says of itself; sizes in bytes, 0 where it does not say.
struct Machine {
  std::string cpu, target, compiler, flags;  // `target`: the instruction set that the kernels take
  unsigned cores = 1;
  std::size_t l1_bytes = 0, l2_bytes = 0, l3_bytes = 0;

  // Measured; 0 until `measure_machine`.
  double clock_ghz = 0;  // of one core at work, by a chain of dependent additions
  /// Single precision, one core; a fused multiply-add is two operations.
  double fma_peak_gflops = 0, fma_peak_median_gflops = 0;
  /// a = b + s·c over arrays far larger than the caches, three numbers a step (what the cache fetches before it writes
  /// is not counted); one core, and all at once.
  double bandwidth_gbps = 0, bandwidth_median_gbps = 0;
  double all_cores_bandwidth_gbps = 0, all_cores_bandwidth_median_gbps = 0;
};

/// Who is here; measures nothing.
Machine describe_machine();

/// Processor, cores, instruction set, compiler and flags, for results.
Json machine_json(const Machine& machine);

/// Takes about a second, and memory of four times the last cache (192 MB to 1.2 GB).
void measure_machine(Machine& machine);

}  // namespace mobil
