#pragma once
// The option --muscles, shared by subcommands that simulate leg muscles.

#include <string>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>

namespace mobil {

/// Reads "usual", "groups", "all" and names of the muscle table, separated by commas. "single" and "members" mean
/// "all". Errors: an unknown name; the message lists the known ones.
Result<MuscleSet> read_muscles(const std::string& text);
/// Returns the names of the muscles, separated by commas.
std::string muscle_list(const MuscleSet& set);

}  // namespace mobil
