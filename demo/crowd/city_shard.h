#pragma once
// The scenes of `mobil crowd` as shards of a crowd on several ranks.

#include <array>
#include <cstdint>
#include <vector>

#include <mobil/cluster.h>
#include <mobil/relevance.h>
#include <mobil/systems/cluster/shard.h>
#include "demo/crowd/crowd_options.h"
#include "demo/crowd/crowd_picture.h"

namespace mobil {

/// What happened in all shards of a rank, as sums; times in s.
struct CityCounts {
  std::uint64_t spawned = 0, despawned = 0, turned = 0, changed_speed = 0, asked = 0;
  std::uint64_t switched = 0, refused = 0, woken = 0, slept = 0, begun = 0;
  double host_s = 0, relevance_s = 0;
};

/// What a shard is like now.
struct CityState {
  std::uint64_t people = 0, bytes = 0, awake = 0, seen = 0;
  std::array<std::size_t, rung_count + 1> muscles_by_rung{};
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

}  // namespace mobil
