#pragma once
// A file of baked bellies (Simulation::bake).

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "engine/error.h"
#include "systems/simulation.h"

namespace mobil {

/// Whole or not at all. Errors: a file that cannot be written.
Result<void> write_baked(const std::filesystem::path& file, std::span<const std::byte> bytes);
/// Errors: a file that cannot be read; what `load_baked` refuses.
Result<void> load_baked(Simulation& simulation, const std::filesystem::path& file);

}  // namespace mobil
