#pragma once
// One body's parameters in full, with the source of every block of figures.

#include <string>

#include <mobil/components/body.h>

namespace mobil {

/// JSON, SI units and degrees as the keys say; numbers to six digits.
std::string body_json(const Body& body);

/// The same in short, for people: what was made of the request, the segments' lengths and masses, the muscles' sizes.
std::string body_table(const Body& body);

}  // namespace mobil
