#pragma once
// A crowd's figures: on the terminal and as JSON.

#include <string>
#include <string_view>
#include <vector>

#include "demo/crowd/crowd_options.h"
#include "demo/crowd/crowd_run.h"
#include "demo/crowd/crowd_scene.h"
#include "demo/program/json.h"

namespace mobil {

/// Heap and resident memory, bytes; 0 where the machine does not tell.
struct CrowdMemory {
  std::size_t per_human = 0, far_human = 0, peak = 0;
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
/// Ticks, those missed, and what they took.
void add_ticks(const std::vector<CrowdTick>& ticks, std::size_t missed, Json& json);
/// What systems took, by name.
void add_systems(const std::vector<CrowdSystem>& systems, Json& json);

std::string tried_line(const CrowdLimit::Tried& tried);
std::string limit_text(const CrowdLimit& limit);
std::string limit_json(const CrowdLimit& limit, const CrowdOptions& options);

}  // namespace mobil
