#pragma once
// `mobil crowd` on several ranks, or in several shards on one.

#include <mobil/engine/error.h>
#include <mobil/systems/cluster/ranks.h>
#include "demo/crowd/crowd_options.h"

namespace mobil {

/// Runs, and at the first rank prints and writes what was asked for. All ranks call it with the same options. Errors,
/// the same on all ranks: what a shard, a file or a folder refuses.
Result<void> run_city(const CrowdOptions& options, Ranks& ranks);

}  // namespace mobil
