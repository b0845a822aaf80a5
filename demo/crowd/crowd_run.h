#pragma once
// Measures the ticks of a crowd and reports them as text and JSON.

#include <string_view>
#include <utility>

#include <mobil/systems/accuracy/accuracy_table.h>
#include "demo/crowd/crowd_options.h"
#include "demo/program/json.h"

namespace mobil {

/// Times of one measured tick, ms: the whole tick in wall-clock time and in processor time of all threads, the host's
/// decisions, and the choice of methods. The rest is the simulation.
struct CrowdTick {
  double wall_ms = 0, cpu_ms = 0, host_ms = 0, lod_ms = 0;
  bool steady = false;  // without arrivals, departures, changes of method or ends of a fade
};

struct CrowdSystem {
  std::string name;
  double mean_ms = 0;  // per tick
};

struct CrowdRun {
  std::vector<CrowdTick> ticks;
  std::vector<CrowdSystem> systems;   // in execution order
  std::vector<std::uint64_t> hashes;  // of the state of all people, every 60 ticks
  bool active = false;                // true if the levels are those of active muscles
  std::array<std::size_t, level_count + 1> muscles_by_level{};
  std::size_t missed = 0, spawned = 0, despawned = 0, switched = 0, refused = 0, turned = 0, changed_speed = 0;
  std::size_t steady_ticks = 0, steady_allocations = 0;
  double tick_s = 0;
};

/// Returns the time, ms, that a fraction `part` (0–1) of the ticks did not exceed; `mean_ms` returns the mean.
double percentile_ms(const std::vector<CrowdTick>& ticks, double part, double CrowdTick::*what = &CrowdTick::wall_ms);
double mean_ms(const std::vector<CrowdTick>& ticks, double CrowdTick::*what);

/// Returns each system's mean time over `ticks` ticks, the number since timings were last reset.
std::vector<CrowdSystem> mean_systems(const Schedule& schedule, std::size_t ticks);

using CrowdLive = std::function<void(const CrowdRun&, std::size_t of)>;

/// Runs a settled crowd for `ticks` ticks. `live` is called up to four times a second, outside the measured time. A
/// tick is missed if its wall-clock time exceeds the time that it simulates. Errors: those of the simulation.
Result<CrowdRun> run_crowd(CrowdScene& scene, std::size_t ticks, bool hashes, const CrowdLive& live = {});

/// Returns the bytes that one distant person takes in the tables, with all muscles, and in the host's records.
std::size_t far_bytes(const CrowdScene& scene);

/// Maximum number of people without missed ticks.
struct CrowdLimit {
  std::size_t people = 0, missed_with = 0;  // missed_with: minimum number that missed ticks; 0: none did
  struct Tried {
    std::size_t people, missed, ticks;
    double p50_ms, p99_ms, max_ms, cpu_p50_ms;
  };
  std::vector<Tried> tried;
};

/// Doubles the crowd until ticks are missed, then bisects four times. A number of people counts as too large if each of
/// three runs of `ticks` ticks missed one, or if the median tick of a run did. Errors: those of the simulation.
Result<CrowdLimit> raise_crowd(CrowdScene& scene, std::size_t ticks, std::size_t most,
                               const std::function<void(const CrowdLimit::Tried&)>& told,
                               const CrowdScene::Progress& progress);

/// Heap and peak resident memory, bytes; 0 if the system does not report it.
struct CrowdMemory {
  std::size_t per_person = 0, far_person = 0, peak = 0;
};
/// Returns the current memory of a settled crowd.
CrowdMemory crowd_memory(const CrowdScene& scene);

/// Returns the peak resident memory of the process, bytes.
std::size_t peak_bytes();

/// Formats one line for the terminal during a run.
std::string crowd_live_line(const CrowdRun& run, std::size_t of);

std::string crowd_text(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene);
std::string crowd_json(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene,
                       const CrowdOptions& options);

/// Formats a line with the number of ticks, of missed ticks, and their times. `of` is appended, as " (slowest rank)".
std::string ticks_line(const std::vector<CrowdTick>& ticks, double tick_s, std::size_t missed,
                       std::string_view of = "");
/// Formats a line with the processor time of the ticks. `of` names what it is summed over.
std::string processor_line(const std::vector<CrowdTick>& ticks, std::string_view of);
/// Formats the mean times of a tick's parts and of systems that took at least `min_ms`, without a final line break.
std::string parts_line(const std::vector<CrowdTick>& ticks, const std::vector<CrowdSystem>& systems, double min_ms);
/// Numbers of muscles by level. `by_method` returns those above 0, with the method's name.
using MusclesByLevel = std::array<std::size_t, level_count + 1>;
std::vector<std::pair<std::string, std::size_t>> by_method(const MusclesByLevel& muscles, bool active);
/// Adds the number of ticks, of missed ticks, and their times.
void add_ticks(const std::vector<CrowdTick>& ticks, std::size_t missed, Json& json);
/// Adds the mean times of systems by name.
void add_systems(const std::vector<CrowdSystem>& systems, Json& json);

std::string tried_line(const CrowdLimit::Tried& tried);
std::string limit_text(const CrowdLimit& limit);
std::string limit_json(const CrowdLimit& limit, const CrowdOptions& options);

}  // namespace mobil
