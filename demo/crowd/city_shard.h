#pragma once
// Scenes of `mobil crowd` and `mobil city` as shards of a crowd on several ranks, and the report of all ranks.

#include <mobil/lod.h>
#include <mobil/systems/cluster/shard.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/crowd/crowd_run.h"

namespace mobil {

/// Counts of events in all shards of a rank; times in s.
struct CityCounts {
  std::uint64_t spawned = 0, despawned = 0, turned = 0, changed_speed = 0, asked = 0;
  std::uint64_t switched = 0, refused = 0, woken = 0, slept = 0, begun = 0;
  double host_s = 0, lod_s = 0;
};

/// Current state of a shard, or a sum over shards.
struct CityState {
  std::uint64_t people = 0, bytes = 0, awake = 0, seen = 0;
  std::array<std::size_t, level_count + 1> muscles_by_level{};
};

/// Adds `more` to `to`.
void add(CityState& to, const CityState& more);

class CityShard : public Shard {
 public:
  virtual Simulation& simulation() = 0;
  virtual CityState state() const = 0;
  /// Returns the people that a picture can show.
  virtual std::vector<CrowdCamera::Drawn> people() const = 0;
};

/// Returns a factory for shards of the requested crowd. `library`, `counts` and `options` must outlive the shards.
Cluster::Make city_shards(const CrowdOptions& options, const Simulation& library, CityCounts& counts);

/// Calls f with each shard of this rank.
template <class F>
void each_shard(Cluster& cluster, F&& f) {
  for (std::uint32_t s = 0; s < cluster.options().shards; ++s)
    if (auto* shard = static_cast<CityShard*>(cluster.shard(s))) f(*shard);
}

/// Results of one rank.
struct CityPart {
  CityState state;
  CityCounts counts;
  ClusterReport report;
  std::uint64_t peak_bytes = 0;
  std::vector<CrowdTick> ticks;
  std::vector<double> system_ms;  // means per tick, in the order of the schedule
};
std::vector<std::byte> pack(const CityPart& part);
Result<CityPart> unpack_part(std::span<const std::byte> bytes);

/// Results of all ranks. A tick takes as long as on the slowest rank.
struct CityRun {
  std::vector<CityPart> parts;
  std::vector<CrowdTick> ticks;  // wall_ms: slowest rank, without waiting; cpu_ms: sum
  std::vector<CrowdSystem> systems;
  CityState state;
  CityCounts counts;
  double tick_s = 0, side_m = 0, sent_bytes_a_tick = 0;
  double wall_s = 0;  // of the first rank, from the first tick to the last, with waiting, without saving
  std::size_t missed = 0;
  std::uint32_t first_tick = 0, last_tick = 0;
  std::vector<std::uint64_t> hashes;
};
/// Combines the parts into the totals.
void put_together(CityRun& run);

std::string city_text(const CityRun& run, const CrowdOptions& options);
std::string city_json(const CityRun& run, const CrowdOptions& options);

/// Runs `mobil city`, or `mobil crowd` in several shards, on one or several ranks. The first rank prints and writes the
/// results. All ranks must call it with the same options. Errors, the same on all ranks: those of a shard, a file or a
/// folder.
Result<void> run_city(const CrowdOptions& options, Ranks& ranks);

}  // namespace mobil
