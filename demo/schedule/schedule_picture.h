#pragma once
// What a tick does, as a picture: systems in the order of running, one a row, against what they read and write, one a
// column.

#include <string>

#include <mobil/schedule.h>

namespace mobil {

/// The whole SVG file. Columns come in the order in which they are first written; those that no system writes come
/// first. A line in a column goes from its first writer to its last reader. Rows of one pass share a ground.
std::string schedule_picture(const Schedule& schedule);

}  // namespace mobil
