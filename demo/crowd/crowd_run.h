#pragma once
// A crowd at work, measured; its figures on the terminal and as JSON.

#include <string_view>
#include <utility>

#include <mobil/systems/accuracy/accuracy_table.h>
#include "demo/crowd/crowd_options.h"
#include "demo/program/json.h"

namespace mobil {

/// One tick as it was measured, ms: what the host decides, the choosing of methods, the simulation; the wall's clock,
/// and the processor time of all threads.
struct CrowdTick {
  double wall_ms = 0, cpu_ms = 0, host_ms = 0, lod_ms = 0;
  bool steady = false;  // nobody came, went, changed method or was done with that
};

struct CrowdSystem {
  std::string name;
  double mean_ms = 0;  // a tick
};

struct CrowdRun {
  std::vector<CrowdTick> ticks;
  std::vector<CrowdSystem> systems;   // in the order of running
  std::vector<std::uint64_t> hashes;  // every 60 ticks, of everybody's state
  bool active = false;                // whose lod_table the levels are of
  std::array<std::size_t, level_count + 1> muscles_by_level{};
  std::size_t missed = 0, spawned = 0, despawned = 0, switched = 0, refused = 0, turned = 0, changed_speed = 0;
  std::size_t steady_ticks = 0, steady_allocations = 0;
  double tick_s = 0;
};

/// Of all ticks: the part (0–1) that took no longer, ms.
double percentile_ms(const std::vector<CrowdTick>& ticks, double part, double CrowdTick::*what = &CrowdTick::wall_ms);
double mean_ms(const std::vector<CrowdTick>& ticks, double CrowdTick::*what);

/// What each system took of so many ticks, since timings were last reset.
std::vector<CrowdSystem> mean_systems(const Schedule& schedule, std::size_t ticks);

using CrowdLive = std::function<void(const CrowdRun&, std::size_t of)>;

/// Runs a settled crowd for so many ticks; `live` is called now and then, outside of what is measured. A tick is missed
/// when the wall's clock says that it took longer than it simulates. Errors: what the simulation refuses.
Result<CrowdRun> run_crowd(CrowdScene& scene, std::size_t ticks, bool hashes, const CrowdLive& live = {});

/// What one of those far away takes of the tables, all muscles included, and of the host's records; bytes.
std::size_t far_bytes(const CrowdScene& scene);

/// The most people that no tick is missed with.
struct CrowdLimit {
  std::size_t people = 0, missed_with = 0;  // the least that was tried and missed; 0: none did
  struct Tried {
    std::size_t people, missed, ticks;
    double p50_ms, p99_ms, max_ms, cpu_p50_ms;
  };
  std::vector<Tried> tried;
};

/// Doubles the crowd until ticks are missed, then halves the difference a few times; a number of people is missed with
/// when each of three runs of so many ticks missed one. Errors: what the simulation refuses.
Result<CrowdLimit> raise_crowd(CrowdScene& scene, std::size_t ticks, std::size_t most,
                               const std::function<void(const CrowdLimit::Tried&)>& told,
                               const CrowdScene::Progress& progress);

/// Heap and resident memory, bytes; 0 where the machine does not tell.
struct CrowdMemory {
  std::size_t per_person = 0, far_person = 0, peak = 0;
};
/// Of a settled crowd as it is now.
CrowdMemory crowd_memory(const CrowdScene& scene);

/// The most memory that the process has held, bytes.
std::size_t peak_bytes();

/// One line for a terminal while it runs.
std::string crowd_live_line(const CrowdRun& run, std::size_t of);

std::string crowd_text(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene);
std::string crowd_json(const CrowdRun& run, const CrowdMemory& memory, const CrowdScene& scene,
                       const CrowdOptions& options);

/// A line of how many ticks there were, how many were missed and how long they took; `of`: of whom, in words.
std::string ticks_line(const std::vector<CrowdTick>& ticks, double tick_s, std::size_t missed,
                       std::string_view of = "");
/// A line of what they took of the processor.
std::string processor_line(const std::vector<CrowdTick>& ticks, std::string_view of);
/// A line of what a tick's parts took, with the systems that took `min_ms` or more; its end is the reader's.
std::string parts_line(const std::vector<CrowdTick>& ticks, const std::vector<CrowdSystem>& systems, double min_ms);
/// Muscles by their method's name, those that there are.
using MusclesByLevel = std::array<std::size_t, level_count + 1>;
std::vector<std::pair<std::string, std::size_t>> by_method(const MusclesByLevel& muscles, bool active);
/// Ticks, those missed, and what they took.
void add_ticks(const std::vector<CrowdTick>& ticks, std::size_t missed, Json& json);
/// What systems took, by name.
void add_systems(const std::vector<CrowdSystem>& systems, Json& json);

std::string tried_line(const CrowdLimit::Tried& tried);
std::string limit_text(const CrowdLimit& limit);
std::string limit_json(const CrowdLimit& limit, const CrowdOptions& options);

}  // namespace mobil
