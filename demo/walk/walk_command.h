#pragma once
// `mobil walk`: motion, muscles, pictures and a scene file of one person.

#include <filesystem>

#include "demo/program/options.h"
#include "demo/walk/figure.h"

namespace mobil {

/// Makes a figure from the real meshes in a folder (demo/anatomy/real_figure.h).
using FigureReader = Result<Figure> (*)(const Person& person, const std::filesystem::path& folder, bool contact);

/// Returns the subcommand. `read_figure` can be null only in mobil, which runs mobil-crowd for `--anatomy`.
Subcommand walk_command(FigureReader read_figure);

}  // namespace mobil
