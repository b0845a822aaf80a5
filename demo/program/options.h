#pragma once
// Subcommands of a program and their options, as plain data. Only options.cpp includes the command-line library,
// because its header takes five seconds to compile.

#include <cstddef>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace mobil {

/// An option, a flag ("--name" with a bool as target) or the positional arguments ("name" with a vector as target). The
/// target keeps its value if the option is absent, and --help shows that value unless it is empty, 0 or false. A vector
/// for "--name" receives one value per occurrence of the option.
struct Option {
  using Target =
      std::variant<bool*, std::string*, std::optional<std::string>*, std::size_t*, std::vector<std::string>*>;
  std::string name;
  Target target;
  std::string help;
  std::string group{};                 // heading in --help; empty: "Options"
  std::vector<std::string> words{};    // values that a shell suggests if `choices` is empty; not checked
  std::vector<std::string> choices{};  // valid values of a text; empty: any
};

/// Returns the names of an array, for a shell to suggest.
template <class Names>
std::vector<std::string> words_of(const Names& names) {
  return {std::begin(names), std::end(names)};
}

/// The option --help of every level.
extern const Option help_option;

struct Subcommand {
  std::string name;
  std::string about{};                 // filled from the table of subcommands (subcommands.h)
  std::string footer{};                // end of --help
  std::vector<Option> options{};       // in the order of --help
  bool last_stands = true;             // true: an option given twice takes its last value; false: an error
  bool empty_refused = false;          // true: an empty value, as from an unset script variable, is an error
  std::function<int()> run = nullptr;  // called after the targets are set; returns the exit status
  std::string program{};               // program that contains it, its heading in --help; empty: the only one
};

struct Program {
  std::string name, about, version, footer;
  std::vector<Option> options{};  // common to all subcommands, after their own
  std::vector<Subcommand> commands{};
};

void add_options(Subcommand& command, const std::vector<Option>& options);

/// Returns the options of a subcommand, including the common ones.
std::vector<Option> all_options(const Program& program, const Subcommand& command);

/// Returns true if a value follows the option.
bool takes_value(const Option& option);

/// Returns the default value that --help shows. It is empty for an empty value, 0 and false.
std::string default_value(const Option& option);

/// Parses the command line and runs its subcommand. Returns the exit status: that of `run`; 0 for --help and --version;
/// 2 for bad usage, with one line on stderr (cause, nearest known name, command for help). If `run` throws, it returns
/// 2 for a filesystem_error and 1 for others.
int run_program(const Program& program, int argc, const char* const* argv);

}  // namespace mobil
