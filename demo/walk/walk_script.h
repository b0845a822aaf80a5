#pragma once
// How a walk changes under way: what `mobil walk --script` reads.

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

/// Rows in order of time; rows of the same time are one change. Values are in m/s, m, Hz and deg, or in the unit of the
/// gait parameter; a speed of 0 is kept as a stop.
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

/// What parameters mean and how they act together, for --help.
extern const std::string_view walk_script_help;

/// Reads CSV text with the columns time_s, parameter, value; `name` is for messages. Fails, naming the line, on a time
/// that is negative or before the row above, an unknown parameter, a value that is no quantity of its kind or out of
/// range, and rows of one time that say the same thing twice.
Result<WalkScript> parse_walk_script(std::string_view text, std::string_view name);

/// The same from a file; also fails where it cannot be read.
Result<WalkScript> read_walk_script(const std::string& path);

/// One change: the whole request that holds from then on, the heading to turn to, and a step aside.
struct ScriptedChange {
  double time_s;
  std::size_t line;  // of its first row
  std::optional<GaitRequest> gait{};
  std::optional<float> heading_rad{};
  std::optional<std::pair<float, float>> aside_m{};  // to the left and ahead
};

/// What the script asks of this body, from the walk it starts with. Fails, naming the line, where a gait is out of the
/// body's range, and where step length or frequency change while the walker stands.
Result<std::vector<ScriptedChange>> plan_changes(const WalkScript& script, const Body& body, const GaitRequest& start);

}  // namespace mobil
