#pragma once
// Quantities as people write them: "180cm", "5km/h", "80", "110steps/min".

#include <string>
#include <string_view>

#include "engine/error.h"

namespace mobil {

enum class Quantity { length, mass, speed, frequency, time };

/// The unit of values without one, as in messages: "m", "kg", …
std::string_view si_unit(Quantity quantity);

/// Reads a number with an optional unit and returns it in SI (m, kg, m/s, Hz, s). Without a unit it is SI already.
/// Errors: not a finite number, or a unit that does not belong to the quantity (the message lists those that do).
Result<double> parse_quantity(const std::string& text, Quantity quantity);

}  // namespace mobil
