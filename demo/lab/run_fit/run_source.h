#pragma once
// The table of running steps as source code.

#include <string>

#include "demo/lab/run_fit/run_grid.h"

namespace mobil {

/// Returns assets/gait/run_table.cpp.
std::string run_source(const std::vector<RunFitNode>& nodes);

}  // namespace mobil
