#pragma once
// Listing and reading of gait parameters (mobil/components/gait.h).

#include <string>
#include <string_view>
#include <vector>

#include <mobil/components/gait.h>
#include <mobil/engine/error.h>

namespace mobil {

/// Returns an aligned table of all parameters with unit, default, range and meaning, and a heading per group.
std::string gait_parameter_table();

std::vector<std::string> gait_parameter_names();

/// Returns the parameter of that name, or null.
const GaitParameter* find_gait_parameter(std::string_view name);

/// Reads a number with an optional unit (10, 10deg, 3cm) within the parameter's range. Errors begin with its name and
/// contain the range.
Result<float> read_gait_parameter(const GaitParameter& parameter, const std::string& text);

/// Reads NAME=VALUE into a style. Errors: no '=', an unknown name (the message suggests the nearest one), a value that
/// is not a number or out of range.
Result<void> set_gait_parameter(const std::string& assignment, GaitStyle& style);

}  // namespace mobil
