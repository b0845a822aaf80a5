#pragma once
// Choice of list entries by name, for commands such as `mobil bench` and `mobil robustness`.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include <mobil/engine/error.h>
#include "demo/program/nearest_name.h"
#include "demo/program/options.h"

namespace mobil {

/// Returns the `name` of each entry.
template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return names;
}

/// Returns the named entries in the list's order, or all if `names` is empty. Fails on an unknown name of that `kind`.
template <class Entries>
Result<std::vector<typename Entries::value_type>> choose_named(const Entries& entries,
                                                               const std::vector<std::string>& names,
                                                               std::string_view kind) {
  using Entry = typename Entries::value_type;
  for (const std::string& name : names) {
    if (std::ranges::find(entries, name, &Entry::name) == entries.end()) {
      const auto known = names_of(entries);
      return fail(fmt::format("there is no {} '{}'{}; choose from: {}", kind, name, suggestion(name, known),
                              fmt::join(known, ", ")));
    }
  }
  std::vector<Entry> chosen;
  std::ranges::copy_if(entries, std::back_inserter(chosen), [&](const Entry& entry) {
    return names.empty() || std::ranges::find(names, entry.name) != names.end();
  });
  return chosen;
}

/// Returns the option for arguments that name entries. `what` is the verb of its help, such as "measure".
template <class Entries>
Option named_option(const Entries& entries, std::vector<std::string>& names, std::string_view what) {
  auto known = names_of(entries);
  return {.name = "name",
          .target = &names,
          .help = fmt::format("Entries to {}, from {}; default: all", what, fmt::join(known, ", ")),
          .words = std::move(known)};
}

}  // namespace mobil
