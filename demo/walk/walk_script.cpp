#include "demo/walk/walk_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>

#include <mobil/assets/files/csv_table.h>
#include <mobil/systems/gait/resolve_gait.h>
#include "demo/program/nearest_name.h"
#include "demo/program/units.h"
#include "demo/walk/gait_parameters.h"

namespace mobil {

const std::string_view walk_script_help =
    "A --script is a CSV file with the columns time_s,parameter,value and rows in order of time:\n"
    "    time_s,parameter,value\n"
    "    2,speed,6km/h\n"
    "    4,heading,45\n"
    "    6,step_length_right,0.6\n"
    "    8,stop,\n"
    "Each change takes effect at the next step. Rows with the same time are one change. Parameters:\n"
    "  speed, step_length, step_frequency   with units as above; 'speed' alone chooses usual steps;\n"
    "                                       one of the others keeps the speed, both at one time set it\n"
    "  step_length_right, step_length_left  uneven steps, right = mean (1 + a), left = mean (1 - a): they\n"
    "                                       set step_length, step_asymmetry (a); one keeps the other\n"
    "  heading                              deg, 0 is the heading at the start, positive to the left\n"
    "  aside, ahead                         a step of a standing person: cm or m to the left and forward,\n"
    "                                       negative to the right and back; both at one time are one step\n"
    "  stop                                 value empty or 1; stands until the next 'speed'\n"
    "  any gait parameter                   see --list-parameters";

namespace {

constexpr std::array<std::string_view, 3> script_columns = {"time_s", "parameter", "value"};

/// A script parameter that is not a gait parameter, with the widest range of any body.
struct Word {
  std::string_view name;
  Quantity quantity;
  double low, high;
};
constexpr Word words[] = {{"speed", Quantity::speed, 0, 10},
                          {"step_length", Quantity::length, 0.01, 3},
                          {"step_frequency", Quantity::frequency, 0.01, 10},
                          {"step_length_right", Quantity::length, 0.01, 3},
                          {"step_length_left", Quantity::length, 0.01, 3},
                          {"heading", Quantity::angle, -360, 360},
                          {"aside", Quantity::length, -1, 1},
                          {"ahead", Quantity::length, -1, 1},
                          {"stop", Quantity::ratio, 1, 1}};

bool one_side(std::string_view name) {
  return name == "step_length_right" || name == "step_length_left";
}

bool sets_pace(std::string_view name) {
  return name == "speed" || name == "step_length" || name == "step_frequency" || one_side(name);
}

/// Returns true if two rows with the same time would set the same quantity.
bool clash(std::string_view a, std::string_view b) {
  const auto pair = [&](auto first, auto second) { return (first(a) && second(b)) || (first(b) && second(a)); };
  const auto is_stop = [](std::string_view name) { return name == "stop"; };
  const auto follows_sides = [](std::string_view name) { return name == "step_length" || name == "step_asymmetry"; };
  return a == b || pair(is_stop, sets_pace) || pair(one_side, follows_sides);
}

Result<float> read_row_value(const std::string& parameter, const std::string& text) {
  if (const GaitParameter* known = find_gait_parameter(parameter)) return read_gait_parameter(*known, text);
  const auto word = std::ranges::find(words, parameter, &Word::name);
  if (word == std::end(words)) {
    auto names = gait_parameter_names();
    std::string first;
    for (const Word& w : words) {
      names.emplace_back(w.name);
      first += fmt::format("{}, ", w.name);
    }
    return fail(fmt::format("there is no parameter '{}'{}; use {}or one of 'mobil walk --list-parameters'", parameter,
                            suggestion(parameter, names), first));
  }
  if (parameter == "stop") {
    if (text.empty() || text == "1") return 1.0F;
    return fail(fmt::format("stop '{}': leave the value empty, or write 1", text));
  }
  const auto value = read_value(word->name, text, word->quantity, word->low, word->high);
  if (!value) return tl::unexpected(value.error());
  return static_cast<float>(*value);
}

Result<WalkScript> from_table(const CsvTable& table) {
  WalkScript script{table.path, {}};
  for (std::size_t r = 0; r < table.row.size(); ++r) {
    const auto refuse = [&](const std::string& what) {
      return fail(fmt::format("{} line {}: {}", table.path, table.line[r], what));
    };
    const auto time_text = number_cell(table, r, script_columns[0]);
    const auto time = number(time_text);
    if (!time || *time < 0) {
      return refuse(
          fmt::format("time_s '{}' is not a number of seconds of at least 0; write one", time_text.substr(0, 60)));
    }
    if (!script.row.empty() && *time < script.row.back().time_s) {
      return refuse(fmt::format("time {} s comes before {} s in the row above; sort the rows by time", *time,
                                script.row.back().time_s));
    }
    std::string parameter(cell(table, r, script_columns[1]));
    const auto value = read_row_value(parameter, number_cell(table, r, script_columns[2]));
    if (!value) return refuse(value.error().message);
    if (parameter == "speed" && *value == 0) parameter = "stop";
    for (auto above = script.row.rbegin(); above != script.row.rend() && above->time_s == *time; ++above) {
      if (!clash(parameter, above->parameter)) continue;
      return refuse(fmt::format("{} conflicts with {} of line {} at the same time; remove one or change its time",
                                parameter, above->parameter, above->line));
    }
    script.row.push_back({*time, table.line[r], std::move(parameter), *value});
  }
  return script;
}

/// The rows with the same time.
struct Moment {
  std::vector<WalkScript::Row>::const_iterator begin, end;

  std::optional<float> operator[](std::string_view name) const {
    const auto found = std::find_if(begin, end, [&](const WalkScript::Row& row) { return row.parameter == name; });
    return found == end ? std::nullopt : std::optional<float>(found->value);
  }
  /// Returns the line to name if the gait cannot be walked.
  std::size_t line() const {
    const auto found = std::find_if(begin, end, [](const WalkScript::Row& row) { return sets_pace(row.parameter); });
    return (found == end ? begin : found)->line;
  }
};

bool standing(const GaitRequest& request) {
  return request.speed_m_s && *request.speed_m_s == 0;
}

/// Sets uneven step lengths. One side alone keeps the length of the other.
Result<void> set_sides(const Body& body, const GaitRequest& before, const Moment& moment, GaitRequest& request,
                       std::optional<float>& length) {
  auto right_m = moment["step_length_right"], left_m = moment["step_length_left"];
  if (!right_m && !left_m) return {};
  if (!right_m || !left_m) {
    const auto walked = resolve_gait(body, before);
    if (!walked) return tl::unexpected(walked.error());
    if (!right_m) right_m = walked->step_length_m * (1 + before.style.step_asymmetry);
    if (!left_m) left_m = walked->step_length_m * (1 - before.style.step_asymmetry);
  }
  const float asymmetry = (*right_m - *left_m) / (*right_m + *left_m);
  const GaitParameter& range = *find_gait_parameter("step_asymmetry");
  if (!(asymmetry >= range.low && asymmetry <= range.high)) {
    return fail(
        fmt::format("steps of {:.3g} m right and {:.3g} m left have a step_asymmetry of {:.2g}, outside the valid "
                    "range {} to {}; reduce their difference",
                    *right_m, *left_m, asymmetry, range.low, range.high));
  }
  request.style.step_asymmetry = asymmetry;
  length = (*right_m + *left_m) / 2;
  return {};
}

Result<void> set_pace(const Body& body, const GaitRequest& before, const Moment& moment, GaitRequest& request) {
  if (moment["stop"]) {
    request.speed_m_s = 0.0F;
    request.step_length_m.reset();
    request.step_frequency_hz.reset();
    return {};
  }
  const auto speed = moment["speed"], frequency = moment["step_frequency"];
  auto length = moment["step_length"];
  const bool sides = moment["step_length_right"] || moment["step_length_left"];
  if (!speed && !frequency && !length && !sides) return {};
  const bool both_sides = moment["step_length_right"] && moment["step_length_left"];
  if (standing(before) && ((!speed && !(frequency && (length || both_sides))) || (sides && !both_sides))) {
    return fail("the walker stands; give a speed at this time, and the lengths of both steps or of neither");
  }
  if (auto done = set_sides(body, before, moment, request, length); !done) return done;
  auto kept = speed;
  if (!speed && !(length && frequency)) {
    const auto walked = resolve_gait(body, before);
    if (!walked) return tl::unexpected(walked.error());
    kept = walked->speed_m_s;
  }
  request.speed_m_s = kept;
  request.step_length_m = length;
  request.step_frequency_hz = frequency;
  return {};
}

}  // namespace

Result<WalkScript> parse_walk_script(std::string_view text, std::string_view name) {
  return parse_csv(text, name, script_columns).and_then(from_table);
}

Result<WalkScript> read_walk_script(const std::string& path) {
  return read_csv(path, script_columns).and_then(from_table);
}

Result<std::vector<ScriptedChange>> plan_changes(const WalkScript& script, const Body& body, const GaitRequest& start) {
  std::vector<ScriptedChange> changes;
  GaitRequest request = start;
  for (Moment moment{script.row.begin(), script.row.begin()}; moment.end != script.row.end();) {
    moment.begin = moment.end;
    moment.end = std::find_if(moment.begin, script.row.end(),
                              [&](const WalkScript::Row& row) { return row.time_s != moment.begin->time_s; });
    ScriptedChange change{moment.begin->time_s, moment.begin->line};
    if (const auto heading = moment["heading"]) change.heading_rad = *heading * (std::numbers::pi_v<float> / 180);
    const auto aside = moment["aside"], ahead = moment["ahead"];
    if (aside || ahead) change.aside_m = {aside.value_or(0.0F), ahead.value_or(0.0F)};
    const bool same_walk = std::all_of(moment.begin, moment.end, [](const WalkScript::Row& row) {
      return row.parameter == "heading" || row.parameter == "aside" || row.parameter == "ahead";
    });
    if (!same_walk) {
      const GaitRequest before = request;
      for (auto row = moment.begin; row != moment.end; ++row) {
        if (const GaitParameter* known = find_gait_parameter(row->parameter)) request.style.*known->value = row->value;
      }
      auto done = set_pace(body, before, moment, request);
      if (done && !standing(request)) {
        if (const auto gait = resolve_gait(body, request); !gait) done = tl::unexpected(gait.error());
      }
      if (!done) return fail(fmt::format("{} line {}: {}", script.path, moment.line(), done.error().message));
      change.gait = request;
    }
    changes.push_back(change);
  }
  return changes;
}

}  // namespace mobil
