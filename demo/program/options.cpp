#include "demo/program/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <filesystem>
#include <sstream>

#include <mobil/engine/error.h>
#include "demo/program/console.h"
#include "demo/program/nearest_name.h"

namespace mobil {
namespace {

CLI::Option* add_option(CLI::App& command, const Option& option) {
  CLI::Option* added = nullptr;
  if (auto* const* flag = std::get_if<bool*>(&option.target)) {
    added = command.add_flag(option.name, **flag, option.help);
  } else if (auto* const* text = std::get_if<std::string*>(&option.target)) {
    added = command.add_option(option.name, **text, option.help);
    if (!option.choices.empty()) added->check(CLI::IsMember(option.choices));
    if (!default_value(option).empty()) added->capture_default_str();
  } else if (auto* const* given = std::get_if<std::optional<std::string>*>(&option.target)) {
    added = command.add_option(option.name, **given, option.help);
  } else if (auto* const* count = std::get_if<std::size_t*>(&option.target)) {
    added = command.add_option(option.name, **count, option.help);
    if (!default_value(option).empty()) added->capture_default_str();
  } else {
    added = command.add_option(option.name, *std::get<std::vector<std::string>*>(option.target), option.help);
    added->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (option.name.starts_with("-")) added->expected(1)->allow_extra_args(false);
  }
  if (!option.group.empty()) added->group(option.group);
  return added;
}

void add_subcommand(CLI::App& app, const Program& program, const Subcommand& from, int& exit_status) {
  CLI::App* command = app.add_subcommand(from.name, from.about);
  command->footer(from.footer);
  if (!from.program.empty() && from.program != program.name) command->group("Subcommands of " + from.program);
  if (from.last_stands) command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  std::vector<Option> options = from.options;
  options.insert(options.end(), program.options.begin(), program.options.end());
  for (const Option& option : options) {
    CLI::Option* added = add_option(*command, option);
    if (!from.empty_refused || added->get_items_expected() == 0) continue;
    added->check([](const std::string& value) {
      return value.empty() ? std::string("is empty; give a value or remove the option") : std::string();
    });
  }
  command->callback([&from, &exit_status] { exit_status = from.run(); });
}

/// Returns the first argument that was not parsed, empty if all were. After a subcommand, unknown options take
/// precedence, because they also leave the arguments after them unparsed.
std::string first_left_over(const CLI::App& app, int argc, const char* const* argv) {
  const auto left = app.remaining(true);
  std::string first;
  for (std::string argument : std::span<const char* const>(argv + 1, argv + argc)) {
    if (std::ranges::find(left, argument) == left.end()) continue;
    if (argument.starts_with("-") && !app.get_subcommands().empty()) return argument;
    if (first.empty()) first = argument;
  }
  return first;
}

/// Returns one line with the subcommand, the argument that was not understood, the nearest known name and the command
/// for help. `app` threw `error` while it parsed `argv`.
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
    what += fmt::format("{}; choose from: {}", suggestion(left, subcommands), fmt::join(subcommands, ", "));
  } else if (!left.empty()) {
    what = fmt::format("'{}' was not expected; options begin with --", left);
  } else if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    what = fmt::format("{} needs one value", what.substr(0, what.find(':')));
  }
  return fmt::format("{}: {}; see '{} --help'", name, what, name);
}

}  // namespace

const Option help_option = {"-h,--help", static_cast<bool*>(nullptr), "Print this help message and exit"};

std::vector<Option> all_options(const Program& program, const Subcommand& command) {
  std::vector<Option> all = {help_option};
  all.insert(all.end(), command.options.begin(), command.options.end());
  all.insert(all.end(), program.options.begin(), program.options.end());
  return all;
}

bool takes_value(const Option& option) {
  return !std::holds_alternative<bool*>(option.target);
}

std::string default_value(const Option& option) {
  if (auto* const* text = std::get_if<std::string*>(&option.target)) return **text;
  if (auto* const* count = std::get_if<std::size_t*>(&option.target); count != nullptr && **count != 0)
    return fmt::format("{}", **count);
  return {};
}

void add_options(Subcommand& command, const std::vector<Option>& options) {
  command.options.insert(command.options.end(), options.begin(), options.end());
}

int run_program(const Program& program, int argc, const char* const* argv) {
  CLI::App app{program.about, program.name};
  app.set_help_flag(help_option.name, help_option.help);
  app.set_version_flag("--version", program.name + " " + program.version);
  app.require_subcommand(1);
  app.footer(program.footer);
  int exit_status = 0;
  for (const Subcommand& command : program.commands) add_subcommand(app, program, command, exit_status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool unknown_subcommand = app.get_subcommands().empty() && !app.remaining().empty();
    if (error.get_exit_code() == 0 && !unknown_subcommand) {  // --help, --version
      std::ostringstream text;
      const int status = app.exit(error, text, text);
      write_output(text.str());
      return status;
    }
    print_error("{}", explain_usage(app, error, argc, argv));
    return 2;
  } catch (const std::filesystem::filesystem_error& error) {
    print_error("{}: {}; name another file or folder", program.name, error.what());
    return 2;
  } catch (const std::exception& error) {
    print_error("{}: {}", program.name, error.what());
    return 1;
  }
  return exit_status;
}

}  // namespace mobil
