#pragma once
// All subcommands, of whichever program they are: `mobil NAME` runs the program beside itself that has NAME.

#include <span>
#include <string_view>

namespace mobil {

struct SubcommandRow {
  std::string_view name, program, help;
  std::string_view former{};  // an older name, which is taken as well
};

/// A program's rows are next to each other, in the order of --help.
std::span<const SubcommandRow> subcommand_rows();

/// By its name or its former one; null where there is none.
const SubcommandRow* find_subcommand(std::string_view name);

}  // namespace mobil
