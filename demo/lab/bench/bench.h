#pragma once
// Common parts of all benches: their input and their results.
//
// A bench is one function, `void bench_x(BenchRun&)`, in a file of its own and one line in the list of
// bench.cpp.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <mobil/engine/error.h>
#include "demo/measure/machine.h"
#include "demo/measure/measure.h"
#include "demo/program/must.h"

namespace mobil {

class BenchCrowd;  // demo/lab/bench/bench_crowd.h

inline constexpr std::size_t muscles_a_person = 8;

/// One figure. `value` is the best of the repeats (highest rate, shortest time), in `unit`.
struct BenchResult {
  std::string name;
  double value = 0;
  std::string unit;
  std::optional<double> median{}, cpu{};            // the same unit
  std::optional<double> of_peak{}, of_bandwidth{};  // fractions of this core's limits
  std::string bound;                                // limiting factor, in words
};

struct BenchRun {
  std::size_t people = 10000;
  bool quick = false;  // one short round instead of many; so far only in the finite-element benches
  Machine machine;
  std::vector<BenchResult> results;
  std::vector<std::string> notes;  // what was not measured, and the reason

  /// Returns a crowd of distinct people, made on first use. Errors: those of spawning.
  BenchCrowd* crowd();
  /// Returns a part of it that fits in the caches; null if the crowd itself is not larger.
  BenchCrowd* small_crowd();

  /// Returns the number of repeats of a measurement that usually has `usual`.
  int rounds(int usual) const { return quick ? 1 : usual; }

  /// Adds the time of one item of a run over `items`. `unit_s` is the unit in s. Valid until the next addition.
  BenchResult& add_time(std::string name, const Measured& time, double items, double unit_s, std::string unit);
  /// Adds a figure without repeats of its own.
  BenchResult& add_figure(std::string name, double value, std::string unit, std::string bound);

 private:
  std::shared_ptr<BenchCrowd> crowd_, small_crowd_;
};

/// Returns "instructions; n multiply-adds at peak take as long".
std::string at_peak(const Machine& machine, double seconds);

void bench_machine(BenchRun& run);
void bench_gait(BenchRun& run);
void bench_kinematics(BenchRun& run);
void bench_lines(BenchRun& run);
void bench_activation(BenchRun& run);
void bench_skinning(BenchRun& run);
void bench_skin(BenchRun& run);
void bench_avoidance(BenchRun& run);
void bench_table1(BenchRun& run);
void bench_fem(BenchRun& run);
void bench_fem_implicit(BenchRun& run);  // the part of bench_fem by CAA, ICD and static on 81 nodes
void bench_modal(BenchRun& run);
void bench_paper_figures(BenchRun& run);
void bench_threads(BenchRun& run);
void bench_lod(BenchRun& run);
void bench_cluster(BenchRun& run);
void bench_crowds(BenchRun& run);

}  // namespace mobil
