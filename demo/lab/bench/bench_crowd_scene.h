#pragma once
// People with leg muscles, more and more of them in one world, ticked by any number of threads.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "demo/measure/measure.h"

namespace mobil {

/// Twelve vectors of the fine mesh, nobody looking.
LegMuscles bench_reduced_muscles();

/// One tick: by the wall's clock, by this process' processor time, and of the latter each system's part in the order of
/// the schedule; the least of all ticks measured, and the median. `serial_share` is the median part of the wall's time
/// in which the tick's caller worked alone, `loops` how often a tick hands out work.
struct BenchTick {
  double wall_s = 0, wall_median_s = 0, cpu_s = 0, cpu_median_s = 0;
  std::vector<double> system_s;
  double serial_share = 0, loops = 0;
};

class BenchScene {
 public:
  static constexpr std::uint64_t seed = 1;

  explicit BenchScene(const LegMuscles& choice);
  BenchScene(const BenchScene&) = delete;
  BenchScene& operator=(const BenchScene&) = delete;

  /// Until there are so many, the people of demo/scene/crowd_people.h, and until they walk steadily. Errors: what the
  /// simulation refuses.
  Result<void> grow_to(std::size_t humans);
  /// Everybody becomes compact (Simulation::compact), and whole again.
  Result<void> compact();
  Result<void> expand();

  std::size_t size() const { return people_.size(); }
  /// Seconds of processor time that the last people took to spawn, each.
  double spawn_s() const { return spawn_s_; }
  /// Bytes of the tables' rows, each.
  double bytes_per_human() const;

  /// By so many threads, at most as many as the machine has. Adds to what was measured before.
  void measure(int threads, int ticks, BenchTick& best);
  /// The pool that `measure` works with; of more threads than one.
  const Threads& pool(int threads);

 private:
  /// Hands the work on to the pool whose turn it is, or does it where it is nobody's; and how long that takes.
  struct Turn {
    const Threads* now = nullptr;
    double handed_out_s = 0;
    std::size_t loops = 0;
  };
  Jobs jobs();

  LegMuscles choice_;
  std::map<int, Threads> pools_;
  Turn turn_;
  Simulation simulation_;
  std::vector<Entity> people_;
  std::size_t drawn_ = 0;
  double spawn_s_ = 0;
  struct Series {
    std::vector<double> wall, cpu, serial_share;
  };
  std::map<int, Series> series_;
};

}  // namespace mobil
