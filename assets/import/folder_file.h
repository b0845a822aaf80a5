#pragma once
// Files that a table or a mesh names in its own folder.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Returns the path of a name below the folder; links are followed. A name without a file stands for the one file that
/// has slashes for its backslashes, or letters of another case. Without such a file it returns the name's own path.
/// Fails on a name that leads out of the folder or fits several files, with a line that lacks the place of the name.
Result<std::filesystem::path> file_below(const std::filesystem::path& folder, std::string_view name);

}  // namespace mobil::inline v0_3
