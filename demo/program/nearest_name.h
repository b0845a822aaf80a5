#pragma once
// What somebody may have meant who wrote a name that is not there.

#include <span>
#include <string>
#include <string_view>

namespace mobil {

/// " (did you mean X?)" with the known name that takes the fewest edits, names that hold the given one first; empty
/// where none is near.
std::string suggestion(std::string_view given, std::span<const std::string> known);

}  // namespace mobil
