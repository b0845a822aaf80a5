#pragma once
// The tables of assets/reference, included in the program by the build.

#include <span>
#include <string_view>

namespace mobil {

struct ReferenceTable {
  std::string_view name, text;  // file name; the whole file
};

std::span<const ReferenceTable> reference_tables();

}  // namespace mobil
