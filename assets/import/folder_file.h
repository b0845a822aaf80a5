#pragma once
// Files that a table or a mesh names in its own folder.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Returns the path of a name below the folder, whose links are followed. A name that does not exist is also looked for
/// with slashes in place of backslashes, and in another case of its letters, if only one file then fits. Without such a
/// file it returns the name's own path. Fails with a line that lacks the place of the name, on a name that leads out of
/// the folder, or fits several files.
Result<std::filesystem::path> file_below(const std::filesystem::path& folder, std::string_view name);

}  // namespace mobil::inline v0_3
