#pragma once
// The scenes of `mobil crowd` as shards of a crowd on several ranks, and the report of all ranks.

#include <mobil/lod.h>
#include <mobil/systems/cluster/shard.h>
#include "demo/crowd/crowd_picture.h"
#include "demo/crowd/crowd_run.h"

namespace mobil {

/// What happened in all shards of a rank, as sums; times in s.
struct CityCounts {
  std::uint64_t spawned = 0, despawned = 0, turned = 0, changed_speed = 0, asked = 0;
  std::uint64_t switched = 0, refused = 0, woken = 0, slept = 0, begun = 0;
  double host_s = 0, lod_s = 0;
};

/// What a shard is like now.
struct CityState {
  std::uint64_t people = 0, bytes = 0, awake = 0, seen = 0;
  std::array<std::size_t, level_count + 1> muscles_by_level{};
};

/// The sums of both.
void add(CityState& to, const CityState& more);

class CityShard : public Shard {
 public:
  virtual Simulation& simulation() = 0;
  virtual CityState state() const = 0;
  /// Whom a picture may show.
  virtual std::vector<CrowdCamera::Drawn> people() const = 0;
};

/// Makes shards of the crowd that is asked for. `library`, `counts` and `options` must live as long as they.
Cluster::Make city_shards(const CrowdOptions& options, const Simulation& library, CityCounts& counts);

/// Those that are on this rank.
template <class F>
void each_shard(Cluster& cluster, F&& f) {
  for (std::uint32_t s = 0; s < cluster.options().shards; ++s)
    if (auto* shard = static_cast<CityShard*>(cluster.shard(s))) f(*shard);
}

/// One rank's part.
struct CityPart {
  CityState state;
  CityCounts counts;
  ClusterReport report;
  std::uint64_t peak_bytes = 0;
  std::vector<CrowdTick> ticks;
  std::vector<double> system_ms;  // means a tick, in the order of the schedule
};
std::vector<std::byte> pack(const CityPart& part);
Result<CityPart> unpack_part(std::span<const std::byte> bytes);

/// All ranks': a tick takes as long as that of the slowest rank.
struct CityRun {
  std::vector<CityPart> parts;
  std::vector<CrowdTick> ticks;  // wall_ms: the slowest rank's, without waiting; cpu_ms: the sum
  std::vector<CrowdSystem> systems;
  CityState state;
  CityCounts counts;
  double tick_s = 0, side_m = 0, sent_bytes_a_tick = 0;
  double wall_s = 0;  // of the first rank from the first tick to the last, with waiting
  std::size_t missed = 0;
  std::uint32_t first_tick = 0, last_tick = 0;
  std::vector<std::uint64_t> hashes;
};
/// Adds up the parts.
void put_together(CityRun& run);

std::string city_text(const CityRun& run, const CrowdOptions& options);
std::string city_json(const CityRun& run, const CrowdOptions& options);

/// Runs `mobil crowd` on several ranks, or in several shards on one, and at the first rank prints and writes what was
/// asked for. All ranks call it with the same options. Errors, the same on all ranks: what a shard, a file or a folder
/// refuses.
Result<void> run_city(const CrowdOptions& options, Ranks& ranks);

}  // namespace mobil
