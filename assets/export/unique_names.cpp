#include "assets/export/unique_names.h"

namespace mobil::inline v0_3 {

std::string UniqueNames::take(const std::string& name) {
  std::string free = name;
  for (int ending = 2; !taken_.insert(free).second; ++ending) free = name + "_" + std::to_string(ending);
  return free;
}

std::string identifier(std::string_view name) {
  std::string made;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    const bool kept = digit || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
    if (made.empty() && digit) made += '_';
    made += kept ? c : '_';
  }
  return made.empty() ? "_" : made;
}

}  // namespace mobil::inline v0_3
