#pragma once
// Numbers as written on the command line. The first byte selects the quantity.

#include <cmath>

#include "demo/program/units.h"
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

inline void fuzz_command(Input input) {
  if (input.empty()) return;
  const auto quantity = static_cast<Quantity>(input[0] % (static_cast<int>(Quantity::ratio) + 1));
  const std::string text(text_of(input.subspan(1)));
  const auto value = read_value("--fuzz", text, quantity, 0.1, 12);
  if (held(value)) promise(*value >= 0.1 && *value <= 12, "a value that is taken lies in its range");
  (void)parse_count(text, 1, 1000);
  promise(!split(text, 'x').empty(), "there is always a part");
  if (const auto list = parse_list<3>(text, '-', 0.1, 12)) {
    for (const double part : *list) promise(part >= 0.1 && part <= 12, "a part that is taken lies in its range");
  }
}

}  // namespace mobil::fuzz
