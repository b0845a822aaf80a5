#pragma once
// The subcommands of a program and their options, as plain data. The library that reads command lines stands in
// options.cpp alone, for its header takes the compiler five seconds.

#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace mobil {

/// One option, one flag ("--name", target a bool) or the arguments without a name ("name", target a vector). The target
/// keeps its value where nothing is given, and --help shows that value unless it is empty, 0 or false. A vector after
/// "--name" takes one value each time that the option is given.
struct Option {
  using Target =
      std::variant<bool*, std::string*, std::optional<std::string>*, std::size_t*, std::vector<std::string>*>;
  std::string name;
  Target target;
  std::string help;
  std::string group{};                 // the heading in --help; empty: "Options"
  std::vector<std::string> words{};    // values that a shell offers where `choices` are empty: no check
  std::vector<std::string> choices{};  // of a text: the only values; empty: any
};

/// Names of an array, for a shell to offer.
template <class Names>
std::vector<std::string> words_of(const Names& names) {
  return {std::begin(names), std::end(names)};
}

/// What --help is, at every level.
extern const Option help_option;

struct Subcommand {
  std::string name;
  std::string about{};                 // filled from the table of subcommands (subcommands.h)
  std::string footer{};                // the end of --help
  std::vector<Option> options{};       // in the order of --help
  bool last_stands = true;             // an option given twice takes its last value; an error otherwise
  bool empty_refused = false;          // an empty value, as scripts leave it, is an error
  std::function<int()> run = nullptr;  // when chosen, after the targets are set; the exit status
  std::string program{};               // the one that has it, which is its heading in --help; empty: the only one
};

struct Program {
  std::string name, about, version, footer;
  std::vector<Option> options{};  // that every subcommand has after its own
  std::vector<Subcommand> commands{};
};

void add_options(Subcommand& command, const std::vector<Option>& options);

/// A subcommand's, with those that every subcommand has.
std::vector<Option> all_options(const Program& program, const Subcommand& command);

/// Whether a value follows it.
bool takes_value(const Option& option);

/// What --help shows as the value where none is given: empty, 0 and false are not shown.
std::string default_value(const Option& option);

/// Reads the command line and runs the subcommand that it names. Exit status: that of `run`; 0 for --help and
/// --version; 2 for bad usage, with one line on stderr that says what, the nearest known name and where to read on; 1
/// where `run` throws.
int run_program(const Program& program, int argc, const char* const* argv);

}  // namespace mobil
