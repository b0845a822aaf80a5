#pragma once
// Names in files: each once, and such as other programs take.

#include <set>
#include <string>
#include <string_view>

namespace mobil::inline v0_3 {

class UniqueNames {
 public:
  /// The name; where it is taken, with the first free ending of _2, _3, …
  std::string take(const std::string& name);

 private:
  std::set<std::string> taken_;
};

/// The name as a programming language's: what is not A–Z, a–z, 0–9 or _ becomes _, and a digit at the beginning gets
/// one before it. An empty name is _.
std::string identifier(std::string_view name);

}  // namespace mobil::inline v0_3
