#pragma once
// Files of baked muscle bellies (MuscleLibrary::bake).

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include <mobil/engine/error.h>
#include <mobil/lod.h>
#include <mobil/simulation.h>

namespace mobil {

/// Writes the file completely or not at all. Errors: a file that cannot be written.
Result<void> write_baked(const std::filesystem::path& file, std::span<const std::byte> bytes);
/// Loads a baked file. Errors: a file that cannot be read; those of `MuscleLibrary::load`.
Result<void> load_baked(Simulation& simulation, const std::filesystem::path& file);
/// Loads the file of `--baked`. If `named` is empty, loads every valid mobil.baked next to the program, installed with
/// it or cached by an earlier run. Results are bit-identical with and without a file. Errors: those of a named file.
Result<void> load_baked_option(Simulation& simulation, const std::filesystem::path& named);
/// Calls Lod::prepare. If that took more than half a second, the muscle library is kept for the next run in the user's
/// cache ($XDG_CACHE_HOME/mobil, or ~/.cache/mobil), if there is one. Errors: those of Lod::prepare.
Result<void> prepare_and_keep(Simulation& simulation, std::span<const float> tolerances_m,
                              const std::function<void(std::size_t done, std::size_t of)>& progress);

}  // namespace mobil
