#include "demo/program/usage.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

#include "demo/program/nearest_name.h"

namespace mobil {
namespace {

/// The first argument, as it was written, that nobody took; empty if all were taken. After a subcommand options go
/// first: what follows an unknown one is left over only because of it.
std::string first_left_over(const CLI::App& app, int argc, const char* const* argv) {
  const auto left = app.remaining(true);
  std::string first;
  for (const std::string argument : std::span<const char* const>(argv + 1, argv + argc)) {
    if (std::ranges::find(left, argument) == left.end()) continue;
    if (argument.starts_with("-") && !app.get_subcommands().empty()) return argument;
    if (first.empty()) first = argument;
  }
  return first;
}

}  // namespace

std::string explain_usage(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  const auto chosen = app.get_subcommands();
  const CLI::App& at = chosen.empty() ? app : *chosen.front();
  const std::string name = chosen.empty() ? app.get_name() : fmt::format("{} {}", app.get_name(), at.get_name());
  const std::string left = first_left_over(app, argc, argv);

  std::vector<std::string> subcommands, options;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    subcommands.push_back(command->get_name());
  }
  for (const auto* option : at.get_options()) {
    for (const auto& known : option->get_lnames()) options.push_back("--" + known);
  }

  std::string what = error.what();
  what = what.substr(0, what.find('\n'));
  if (left.starts_with("-")) {
    const std::string option = left.substr(0, left.find('='));
    const bool misplaced = std::ranges::find(options, option) != options.end();
    what = misplaced ? fmt::format("{} goes after the subcommand", option)
                     : fmt::format("there is no option {}{}", option, suggestion(option, options));
  } else if (chosen.empty()) {
    what = left.empty() ? "a subcommand is missing" : fmt::format("there is no subcommand '{}'", left);
    what += fmt::format("{}; there are: {}", suggestion(left, subcommands), fmt::join(subcommands, ", "));
  } else if (!left.empty()) {
    what = fmt::format("'{}' was not expected; options begin with --", left);
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    what = fmt::format("{} needs one value", what.substr(0, what.find(':')));
  }
  return fmt::format("{}: {}; see '{} --help'\n", name, what, name);
}

}  // namespace mobil
