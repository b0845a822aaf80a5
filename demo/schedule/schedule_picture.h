#pragma once
// A picture of a tick, with a row per system, in execution order, and a column per type that systems read or write.

#include <string>

#include <mobil/schedule.h>

namespace mobil {

/// Returns the SVG file. Columns are in the order of their first write; those that no system writes come first. The
/// line in a column spans the first to the last system that accesses it. Rows of one pass share a background.
std::string schedule_picture(const Schedule& schedule);

}  // namespace mobil
