#pragma once
// What every bench is made of: what it is asked, and what it hands back.
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

/// One figure; `value` is the best of the repeats (of a rate the highest, of a time the least), in `unit`.
struct BenchResult {
  std::string name;
  double value = 0;
  std::string unit;
  std::optional<double> median{}, cpu{};            // the same unit
  std::optional<double> of_peak{}, of_bandwidth{};  // fractions of this core's limits
  std::string bound;                                // what holds it back, in words
};

struct BenchRun {
  std::size_t people = 10000;
  bool quick = false;  // one short round where there would be many; so far of the finite-element benches
  Machine machine;
  std::vector<BenchResult> results;
  std::vector<std::string> notes;  // what was not measured, and why

  /// A crowd in which everybody is someone else; made when first asked for. Errors: those of spawning.
  BenchCrowd* crowd();
  /// A part of it small enough for the caches; null when the crowd itself is no larger.
  BenchCrowd* small_crowd();

  /// How often to do what is usually done `usual` times.
  int rounds(int usual) const { return quick ? 1 : usual; }

  /// Adds the time of one item, `unit_s` the unit in s, of a run over `items`. Good until the next is added.
  BenchResult& add_time(std::string name, const Measured& time, double items, double unit_s, std::string unit);
  /// A figure without repeats of its own.
  BenchResult& add_figure(std::string name, double value, std::string unit, std::string bound);

 private:
  std::shared_ptr<BenchCrowd> crowd_, small_crowd_;
};

/// "instructions; n multiply-adds at peak take as long".
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
