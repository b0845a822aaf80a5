#pragma once
// `mobil crowd --alive`: very many people, most of them asleep, measured and drawn.

#include "demo/crowd/crowd_options.h"
#include "engine/error.h"

namespace mobil {

/// Runs, prints, and writes the report and pictures asked for. Errors: what the simulation or a file refuses.
Result<void> run_alive(const CrowdOptions& options);

}  // namespace mobil
