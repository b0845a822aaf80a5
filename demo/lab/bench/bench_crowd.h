#pragma once
// A crowd of distinct people, and the times of its systems.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <mobil/engine/error.h>
#include <mobil/schedule.h>
#include <mobil/simulation.h>
#include "demo/measure/measure.h"
#include "demo/scene/crowd_people.h"

namespace mobil {

/// The people of demo/scene/crowd_people.h.
class BenchCrowd {
 public:
  static constexpr std::uint64_t seed = 1;

  /// Spawns people one after the other, with a progress bar on a terminal. A person who cannot walk as drawn is drawn
  /// again. After twenty refusals in a row throws Stopped with the last one.
  explicit BenchCrowd(std::size_t people);
  BenchCrowd(const BenchCrowd&) = delete;
  BenchCrowd& operator=(const BenchCrowd&) = delete;

  Simulation& simulation() { return simulation_; }
  const std::vector<Entity>& people() const { return people_; }
  std::size_t size() const { return people_.size(); }
  const Measured& spawn() const { return spawn_; }  // of one person; `best_s` is the mean
  std::size_t drawn_again() const { return drawn_again_; }

  /// Returns each system's time for one steady tick over the whole crowd, by name; measured on first use.
  const std::map<std::string, Measured, std::less<>>& steady_ticks();
  /// Returns the bytes that a system reads and writes for one person and tick, by its signature, each once. 0 for a
  /// system that does not exist or has no rows.
  std::size_t bytes_per_person(std::string_view system);

  /// Returns the seconds for which each system, in the order of the schedule, had a processor while `work` ran. Resets
  /// the schedule's timings.
  std::vector<double> cpu_of(const std::function<void()>& work);

  /// Requests another speed for all people, drawn as the first one was. Throws Stopped at the first refusal.
  void change_speeds(std::uint32_t round, float forward_swing);

 private:
  const Table* table_of(const System& system) const;

  Simulation simulation_;
  std::vector<Entity> people_;
  std::vector<CrowdPerson> asked_;
  Measured spawn_;
  std::size_t drawn_again_ = 0;
  std::map<std::string, Measured, std::less<>> steady_;
};

}  // namespace mobil
