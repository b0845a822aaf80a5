#pragma once
// Unique names in files, in a form that other programs accept.

#include <set>
#include <string>
#include <string_view>

namespace mobil::inline v0_3 {

class UniqueNames {
 public:
  /// Returns the name; if it is taken, with the first free ending of _2, _3, …
  std::string take(const std::string& name);

 private:
  std::set<std::string> taken_;
};

/// Returns the name as an identifier. Characters other than A–Z, a–z, 0–9 or _ become _, and a leading digit gets one
/// before it. An empty name is _.
std::string identifier(std::string_view name);

}  // namespace mobil::inline v0_3
