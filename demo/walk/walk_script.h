#pragma once
// Scripts of changes during a walk, as read by `mobil walk --script`.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/components/body.h>
#include <mobil/components/gait.h>
#include <mobil/engine/error.h>

namespace mobil {

/// A script with rows in order of time; rows with the same time are one change. Values are in m/s, m, Hz and deg, or in
/// the unit of the gait parameter. A speed of 0 is stored as a stop.
struct WalkScript {
  struct Row {
    double time_s;
    std::size_t line;  // in the file, from 1
    std::string parameter;
    float value;
  };
  std::string path;
  std::vector<Row> row;
};

/// Part of --help about scripts.
extern const std::string_view walk_script_help;

/// Reads CSV text with the columns time_s, parameter, value; `name` is for messages. Errors name the line. They are a
/// negative or decreasing time, an unknown parameter, a value with a wrong unit or out of range, and rows with the same
/// time that set the same quantity.
Result<WalkScript> parse_walk_script(std::string_view text, std::string_view name);

/// Reads a script from a file. Errors: those of parse_walk_script, a file that cannot be read.
Result<WalkScript> read_walk_script(const std::string& path);

/// One change: the complete gait request from then on, the heading to turn to, and a step aside.
struct ScriptedChange {
  double time_s;
  std::size_t line;  // of its first row
  std::optional<GaitRequest> gait{};
  std::optional<float> heading_rad{};
  std::optional<std::pair<float, float>> aside_m{};  // to the left and ahead
};

/// Returns the changes of a script for this body and initial walk. Errors, with the line: a gait out of the body's
/// range, a change of step length or frequency while the walker stands.
Result<std::vector<ScriptedChange>> plan_changes(const WalkScript& script, const Body& body, const GaitRequest& start);

}  // namespace mobil
