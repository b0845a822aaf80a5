#pragma once
// `mobil effects --shapes DIR`: the tables of bellies at finite strain, made again.

#include <string>

#include "engine/error.h"

namespace mobil {

/// Writes assets/finite/tables into the folder, a file a muscle, and prints how near each is to shapes that it was not
/// made from. Some minutes.
Result<void> write_finite_tables(const std::string& folder);

}  // namespace mobil
