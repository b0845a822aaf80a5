#pragma once
// Suggestions for unknown names.

#include <span>
#include <string>
#include <string_view>

namespace mobil {

/// Returns " (did you mean X?)" with the known name that needs the fewest edits. Names that contain the given one come
/// first. Returns an empty text if no name is near.
std::string suggestion(std::string_view given, std::span<const std::string> known);

}  // namespace mobil
