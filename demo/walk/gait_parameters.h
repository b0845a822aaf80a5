#pragma once
// The gait parameters (mobil/components/gait_style.h) as people list and set them.

#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/gait_style.h>
#include <mobil/engine/error.h>

namespace mobil {

/// Every parameter with its unit, default, range and meaning, as an aligned table with a heading a group.
std::string gait_parameter_table();

std::vector<std::string> gait_parameter_names();

/// Null where there is no parameter of that name.
const GaitParameter* find_gait_parameter(std::string_view name);

/// A number with an optional unit (10, 10deg, 3cm), within the parameter's range. Errors begin with its name and say
/// the range.
Result<float> read_gait_parameter(const GaitParameter& parameter, const std::string& text);

/// Reads NAME=VALUE into a style. Errors: no '=', an unknown name (the nearest known one is named), a value that is not
/// a number or out of range.
Result<void> set_gait_parameter(const std::string& assignment, GaitStyle& style);

}  // namespace mobil
