#pragma once
// All subcommands of all programs. `mobil NAME` runs the program in its folder that contains NAME.

#include <span>
#include <string_view>

namespace mobil {

struct SubcommandRow {
  std::string_view name, program, help;
  std::string_view former{};  // an older name, still accepted
};

/// Returns the table. Rows of one program are adjacent, in the order of --help.
std::span<const SubcommandRow> subcommand_rows();

/// Returns the row with this name or former name, or null.
const SubcommandRow* find_subcommand(std::string_view name);

}  // namespace mobil
