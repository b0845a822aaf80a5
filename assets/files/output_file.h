#pragma once
// Results on disk: complete under their final name, or not there at all.

#include <filesystem>
#include <string_view>

#include "engine/error.h"

namespace mobil {

/// Writes the text to a temporary file beside `path` and renames it. Errors: folder missing or not writable, disk full;
/// nothing is left behind.
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

/// Makes a folder for results (with its parents) and proves that a file can be written in it.
Result<void> make_output_folder(const std::filesystem::path& folder);

}  // namespace mobil
