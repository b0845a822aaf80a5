#pragma once
// A table of comma-separated values.

#include <array>

#include <mobil/assets/files/csv_table.h>
#include "tests/fuzz/fuzz_input.h"

namespace mobil::fuzz {

inline void fuzz_table(Input input) {
  const std::string_view text = text_of(input);
  constexpr std::array<std::string_view, 3> needed = {"time_s", "parameter", "value"};
  for (const bool any : {false, true}) {
    const auto table = parse_csv(text, "fuzz.csv", any ? std::span<const std::string_view>{} : needed);
    if (!held(table)) continue;
    promise(table->line.size() == table->row.size(), "every row has its line");
    for (std::size_t row = 0; row < table->row.size(); ++row) {
      promise(table->row[row].size() == table->header.size(), "every row is as wide as the header");
      for (const auto column : needed) (void)number(number_cell(*table, row, column));
    }
  }
  (void)number(text);
}

}  // namespace mobil::fuzz
