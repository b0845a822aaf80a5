#pragma once
// Quantities as people write them: "180cm", "5km/h", "80", "110steps/min".

#include <string>
#include <string_view>

#include "engine/error.h"

namespace mobil {

enum class Quantity { length, mass, speed, frequency, time, angle, pressure, density, rate, stiffness, ratio };

/// The unit of values without one, as in messages: "m", "kg", …; empty for a ratio, which has none.
std::string_view base_unit(Quantity quantity);

/// Reads a number with an optional unit and returns it in the base unit: m, kg, m/s, Hz, s, deg (angles alone are not
/// in SI), Pa, kg/m3, 1/s, N/m, 1. Errors: not a finite number, or a unit that does not belong to the quantity (the
/// message lists those that do).
Result<double> parse_quantity(const std::string& text, Quantity quantity);

/// The value of an option, or of what else `name` says; messages begin with the name.
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity);

/// The same; also fails outside `low` to `high` (base unit).
Result<double> read_value(std::string_view name, const std::string& text, Quantity quantity, double low, double high);

}  // namespace mobil
