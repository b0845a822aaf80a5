#pragma once
// A crowd's figures: on the terminal and as JSON.

#include <array>
#include <string>
#include <string_view>
#include <utility>
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
/// A line of what a tick's parts took, with the systems that took `least_ms` or more; its end is the reader's.
std::string parts_line(const std::vector<CrowdTick>& ticks, const std::vector<CrowdSystem>& systems, double least_ms);
/// Muscles by their method's name, those that there are.
using MusclesByRung = std::array<std::size_t, rung_count + 1>;
std::vector<std::pair<std::string, std::size_t>> by_method(const MusclesByRung& muscles, bool living);
/// Ticks, those missed, and what they took.
void add_ticks(const std::vector<CrowdTick>& ticks, std::size_t missed, Json& json);
/// What systems took, by name.
void add_systems(const std::vector<CrowdSystem>& systems, Json& json);

std::string tried_line(const CrowdLimit::Tried& tried);
std::string limit_text(const CrowdLimit& limit);
std::string limit_json(const CrowdLimit& limit, const CrowdOptions& options);

}  // namespace mobil
