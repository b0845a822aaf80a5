#pragma once
// A crowd as a scene for other programs: everybody dressed, walking.

#include <cstddef>
#include <filesystem>
#include <vector>

#include <mobil/assets/export/walk_recording.h>
#include <mobil/engine/error.h>
#include "demo/crowd/crowd_scene.h"

namespace mobil {

/// Poses that a recording may hold, 1.3 kB each.
inline constexpr std::size_t most_recorded_poses = 800'000;

/// Files that a crowd can be written to, by their ending. Errors: another ending, twice the same name, a place that
/// cannot be written.
Result<void> check_crowd_exports(const std::vector<std::filesystem::path>& files);

/// Everybody, as many pictures a second as films have, for `seconds` from now on, in which the crowd goes on. People
/// are called person_NUMBER, by their number in the crowd. Nobody may leave meanwhile. Errors: what the simulation
/// refuses.
Result<CrowdRecording> record_crowd(CrowdScene& scene, double seconds, const CrowdScene::Progress& progress = {});

/// Writes the recording to each file. Errors begin with the option.
Result<void> write_crowd_exports(const CrowdRecording& recording, const std::vector<std::filesystem::path>& files);

}  // namespace mobil
