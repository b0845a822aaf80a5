#pragma once
// `mobil walk`: one person from parameters to motion, muscles, pictures and a scene file.

#include <filesystem>

#include "demo/program/options.h"
#include "demo/walk/figure.h"

namespace mobil {

/// Makes a figure of the real meshes in a folder (demo/anatomy/real_figure.h).
using FigureReader = Result<Figure> (*)(const Person& person, const std::filesystem::path& folder, bool contact);

/// Without a reader, `--anatomy` must not get this far: mobil runs mobil-crowd for it.
Subcommand walk_command(FigureReader read_figure);

}  // namespace mobil
