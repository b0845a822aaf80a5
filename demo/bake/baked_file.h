#pragma once
// A file of baked bellies (MuscleLibrary::bake).

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include <mobil/engine/error.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>

namespace mobil {

/// Whole or not at all. Errors: a file that cannot be written.
Result<void> write_baked(const std::filesystem::path& file, std::span<const std::byte> bytes);
/// Errors: a file that cannot be read; what `MuscleLibrary::load` refuses.
Result<void> load_baked(Simulation& simulation, const std::filesystem::path& file);
/// Of the file that `--baked` names; where it names none, of the mobil.baked beside the program or installed with it,
/// or of what an earlier run has kept, if there is one that fits. Bits are the same with and without. Errors: those of
/// a file that was named.
Result<void> load_baked_option(Simulation& simulation, const std::filesystem::path& named);
/// Lod::prepare. What took more than half a second to make is kept for the next run, in the user's cache
/// ($XDG_CACHE_HOME/mobil, or ~/.cache/mobil), where there is one. Errors: those of preparing.
Result<void> prepare_and_keep(Simulation& simulation, std::span<const float> tolerances_m,
                              const std::function<void(std::size_t done, std::size_t of)>& progress);

}  // namespace mobil
