#pragma once
// An option whose value is one of a few names.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil {

/// One of an enumeration's names, which stand in its order. Errors name the option and all that there are.
template <class E, class Names>
Result<E> choose(std::string_view option, const std::string& text, const Names& names) {
  const auto found = std::find(std::begin(names), std::end(names), text);
  if (found != std::end(names)) return static_cast<E>(found - std::begin(names));
  return fail(fmt::format("{} '{}': choose one of {}", option, text, fmt::join(names, ", ")));
}

}  // namespace mobil
