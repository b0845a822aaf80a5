#pragma once
// `mobil city`: very many people, most of them asleep, measured and drawn.

#include <mobil/engine/error.h>
#include "demo/crowd/crowd_options.h"

namespace mobil {

/// So many pictures are taken, spread over a run's ticks: picture i after this many; into files with its number.
inline constexpr std::size_t alive_pictures = 3;
constexpr std::size_t alive_picture_tick(std::size_t i, std::size_t ticks) {
  return (2 * i + 1) * ticks / (2 * alive_pictures);
}
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t number);

/// Runs, prints, and writes the report and pictures asked for. Errors: what the simulation or a file refuses.
Result<void> run_alive(const CrowdOptions& options);

}  // namespace mobil
