#include "demo/walk/gait_parameters.h"

#include <fmt/format.h>

#include <iterator>

#include "demo/program/nearest_name.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

/// A heading, and the first parameter of its group.
struct Heading {
  std::string_view first, text;
};
constexpr Heading headings[] = {{"pelvis_rotation_deg", "Pelvis"},     {"step_width_h", "Steps"},
                                {"strike_pitch_deg", "Legs and feet"}, {"foot_pivot_h", "Support on the stance leg"},
                                {"trunk_lean_deg", "Trunk"},           {"arm_back_deg", "Arms and hands"}};

Quantity quantity_of(const GaitParameter& parameter) {
  if (parameter.unit == "deg") return Quantity::angle;
  if (parameter.unit == "m") return Quantity::length;
  if (parameter.unit == "N/m") return Quantity::stiffness;
  return Quantity::ratio;  // of body height, of the gait cycle, of something else
}

}  // namespace

std::string gait_parameter_table() {
  std::string text =
      "Gait parameters: mobil walk --set NAME=VALUE, or NAME as the parameter of a --script row.\n"
      "Units: height is a fraction of body height, cycle one of the gait cycle (two steps), 1 a number.\n";
  const auto row = [&](auto name, auto value, auto low, auto high, auto unit, auto meaning) {
    fmt::format_to(std::back_inserter(text), "  {:<23}{:>8}{:>8}{:>8}  {:<8}{}\n", name, value, low, high, unit,
                   meaning);
  };
  const GaitStyle style;
  for (const GaitParameter& parameter : gait_parameters) {
    for (const Heading& heading : headings) {
      if (heading.first != parameter.name) continue;
      text += fmt::format("\n{}\n", heading.text);
      row("name", "default", "from", "to", "unit", "meaning");
    }
    row(parameter.name, style.*parameter.value, parameter.low, parameter.high, parameter.unit, parameter.meaning);
  }
  return text;
}

std::vector<std::string> gait_parameter_names() {
  std::vector<std::string> names;
  names.reserve(gait_parameters.size());
  for (const GaitParameter& parameter : gait_parameters) names.emplace_back(parameter.name);
  return names;
}

const GaitParameter* find_gait_parameter(std::string_view name) {
  for (const GaitParameter& parameter : gait_parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

Result<float> read_gait_parameter(const GaitParameter& parameter, const std::string& text) {
  const auto value = read_value(parameter.name, text, quantity_of(parameter));
  if (!value) return tl::unexpected(value.error());
  const auto single = static_cast<float>(*value);  // precision of the range, so that 0.03 is within 0 to 0.03
  if (single >= parameter.low && single <= parameter.high) return single;
  return fail(fmt::format("{} {}: outside the valid range {} to {}{}; choose a value inside it", parameter.name, text,
                          parameter.low, parameter.high,
                          parameter.unit == "1" ? "" : fmt::format(" {}", parameter.unit)));
}

Result<void> set_gait_parameter(const std::string& assignment, GaitStyle& style) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    return fail(fmt::format(
        "'{}': write NAME=VALUE, like toe_out_deg=10; 'mobil walk --list-parameters' lists the names", assignment));
  }
  const std::string name = assignment.substr(0, equals);
  const GaitParameter* parameter = find_gait_parameter(name);
  if (parameter == nullptr) {
    return fail(fmt::format("{}: there is no such parameter{}; see 'mobil walk --list-parameters'", name,
                            suggestion(name, gait_parameter_names())));
  }
  const auto value = read_gait_parameter(*parameter, assignment.substr(equals + 1));
  if (!value) return tl::unexpected(value.error());
  style.*parameter->value = *value;
  return {};
}

}  // namespace mobil
