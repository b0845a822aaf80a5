#pragma once
// A crowd on several ranks, measured: what each rank has to say, put together.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "demo/crowd/city_shard.h"
#include "demo/crowd/crowd_run.h"

namespace mobil {

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

}  // namespace mobil
