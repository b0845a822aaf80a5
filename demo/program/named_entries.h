#pragma once
// What commands share that run the entries of a list, `mobil bench` and `mobil robustness`: choosing them by name.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include <mobil/engine/error.h>
#include "demo/program/nearest_name.h"
#include "demo/program/options.h"

namespace mobil {

/// The names of entries, each of which has a `name`.
template <class Entries>
std::vector<std::string> names_of(const Entries& entries) {
  std::vector<std::string> names;
  names.reserve(entries.size());
  for (const auto& entry : entries) names.emplace_back(entry.name);
  return names;
}

/// Those that were named, in the list's order; all where none was. Fails on an unknown name. `kind` is for the message.
template <class Entries>
Result<std::vector<typename Entries::value_type>> choose_named(const Entries& entries,
                                                               const std::vector<std::string>& names,
                                                               std::string_view kind) {
  using Entry = typename Entries::value_type;
  for (const std::string& name : names) {
    if (std::ranges::find(entries, name, &Entry::name) == entries.end()) {
      const auto known = names_of(entries);
      return fail(fmt::format("there is no {} '{}'{}; there are: {}", kind, name, suggestion(name, known),
                              fmt::join(known, ", ")));
    }
  }
  std::vector<Entry> chosen;
  std::ranges::copy_if(entries, std::back_inserter(chosen), [&](const Entry& entry) {
    return names.empty() || std::ranges::find(names, entry.name) != names.end();
  });
  return chosen;
}

/// The arguments that name entries. `what` is done with them: "measure".
template <class Entries>
Option named_option(const Entries& entries, std::vector<std::string>& names, std::string_view what) {
  auto known = names_of(entries);
  return {.name = "name",
          .target = &names,
          .help = fmt::format("What to {}, of {}; all by default", what, fmt::join(known, ", ")),
          .words = std::move(known)};
}

}  // namespace mobil
