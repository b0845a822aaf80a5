#include "demo/lab/completion/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string_view>
#include <vector>

#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/named_entries.h"
#include "demo/program/program.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

const std::vector<std::string>& words_of_option(const Option& option) {
  return option.choices.empty() ? option.words : option.choices;
}

bool is_argument(const Option& option) {
  return !option.name.starts_with("-");
}

/// Puts a backslash before each of `marks`.
std::string escaped(std::string_view text, std::string_view marks) {
  std::string out;
  for (const char c : text) {
    if (marks.find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Puts text in single quotes, as bash and zsh read them.
std::string shell_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string fish_quoted(std::string_view text) {
  return "'" + escaped(text, "\\'") + "'";
}

std::vector<std::string> command_names(const Program& program) {
  std::vector<std::string> names;
  for (const Subcommand& command : program.commands) names.push_back(command.name);
  return names;
}

std::string bash_command(const Program& program, const Subcommand& command) {
  std::string values, arguments;
  bool has_arguments = false;
  std::vector<std::string> names, files;
  for (const Option& option : all_options(program, command)) {
    const auto& words = words_of_option(option);
    if (is_argument(option)) {
      has_arguments = true;
      arguments += fmt::format("{} ", fmt::join(words, " "));
      continue;
    }
    for (const std::string& name : split(option.name, ',')) {
      names.push_back(name);
      if (!takes_value(option)) continue;
      if (words.empty()) {
        files.push_back(name);
      } else {
        values +=
            fmt::format("        {}) words={} ;;\n", name, shell_quoted(fmt::format("{}", fmt::join(words, " "))));
      }
    }
  }
  std::string text = fmt::format("    {})\n      case $before in\n", command.name);
  if (!files.empty()) text += fmt::format("        {}) return ;;  # a file, or a number\n", fmt::join(files, "|"));
  text += values;
  const std::string options = shell_quoted(fmt::format("{}", fmt::join(names, " ")));
  if (has_arguments) {
    text += fmt::format("        *)\n          words={}\n          case $word in -*) words={} ;; esac ;;\n",
                        shell_quoted(arguments), options);
  } else {
    text += fmt::format("        *) words={} ;;\n", options);
  }
  return text + "      esac ;;\n";
}

std::string zsh_value(const Option& option) {
  const auto& words = words_of_option(option);
  return words.empty() ? "_files" : fmt::format("({})", fmt::join(words, " "));
}

/// Returns one line of _arguments.
std::string zsh_option(const Option& option) {
  if (is_argument(option)) return shell_quoted(fmt::format("*:{}:{}", option.name, zsh_value(option)));
  const auto names = split(option.name, ',');
  const std::string help = fmt::format("[{}]", escaped(option.help, "[]:\\"));
  const bool again = std::holds_alternative<std::vector<std::string>*>(option.target);
  const std::string value = takes_value(option) ? fmt::format(":value:{}", zsh_value(option)) : std::string();
  const std::string others = again ? "*" : fmt::format("({})", fmt::join(names, " "));
  const std::string_view sign = takes_value(option) ? "=" : "";
  std::vector<std::string> lines;
  lines.reserve(names.size());
  for (const std::string& name : names)
    lines.push_back(shell_quoted(fmt::format("{}{}{}{}{}", others, name, sign, help, value)));
  return fmt::format("{}", fmt::join(lines, " "));
}

std::string fish_option(const Option& option, const std::string& condition, const std::string& program) {
  const auto& words = words_of_option(option);
  std::string line = fmt::format("complete -c {} -n {}", program, condition);
  if (is_argument(option)) {
    if (words.empty()) return line + " -F\n";
    return line + fmt::format(" -f -a {}\n", fish_quoted(fmt::format("{}", fmt::join(words, " "))));
  }
  for (const std::string& name : split(option.name, ','))
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (takes_value(option)) {
    line += words.empty() ? " -r -F" : " -x -a " + fish_quoted(fmt::format("{}", fmt::join(words, " ")));
  }
  return line + " -d " + fish_quoted(option.help) + "\n";
}

struct Shell {
  std::string_view name;
  std::string (*script)(const Program&);
};

const std::vector<Shell> shells = {{"bash", &bash_completion}, {"zsh", &zsh_completion}, {"fish", &fish_completion}};

Result<void> run_completion(const std::vector<std::string>& names) {
  const auto chosen = choose_named(shells, names, "shell");
  if (!chosen) return tl::unexpected(chosen.error());
  if (names.size() != 1) return fail("name one shell: mobil completion bash, zsh or fish");
  write_output(chosen->front().script(mobil_program()));
  return {};
}

}  // namespace

std::string bash_completion(const Program& program) {
  std::string text = fmt::format(
      "# Written by `{0} completion bash`. Do not edit.\n"
      "_{0}() {{\n"
      "  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command= words= i\n"
      "  COMPREPLY=()\n"
      "  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    [[ ${{COMP_WORDS[i]}} == -* ]] || {{ command=${{COMP_WORDS[i]}}; break; }}\n"
      "  done\n"
      "  case $command in\n"
      "    '') words={1} ;;\n",
      program.name,
      shell_quoted(fmt::format("{} --version {}", fmt::join(command_names(program), " "),
                               fmt::join(split(help_option.name, ','), " "))));
  for (const Subcommand& command : program.commands) text += bash_command(program, command);
  return text + fmt::format(
                    "  esac\n"
                    "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
                    "}}\n"
                    "complete -o bashdefault -o default -F _{0} {0}\n",
                    program.name);
}

std::string zsh_completion(const Program& program) {
  std::string text = fmt::format(
      "#compdef {0}\n# Written by `{0} completion zsh`. Do not edit.\n"
      "_{0}() {{\n"
      "  local context curcontext=$curcontext state state_descr line\n"
      "  typeset -A opt_args\n"
      "  _arguments -C {1} '--version[Print the version and exit]' '1:subcommand:->subcommand' '*::option:->option'\n"
      "  case $state in\n"
      "    subcommand)\n"
      "      local -a subcommands=(\n",
      program.name, zsh_option(help_option));
  for (const Subcommand& command : program.commands)
    text += fmt::format("        {}\n", shell_quoted(command.name + ":" + escaped(command.about, "\\")));
  text += "      )\n      _describe subcommand subcommands ;;\n    option)\n      case $line[1] in\n";
  for (const Subcommand& command : program.commands) {
    text += fmt::format("        {})\n          _arguments", command.name);
    for (const Option& option : all_options(program, command)) text += " \\\n            " + zsh_option(option);
    text += " ;;\n";
  }
  return text +
         fmt::format(
             "      esac ;;\n  esac\n}}\nif [[ $funcstack[1] == _{0} ]]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n",
             program.name);
}

std::string fish_completion(const Program& program) {
  const std::string before = "__fish_use_subcommand";
  std::string text = fmt::format("# Written by `{0} completion fish`. Do not edit.\n", program.name);
  text += fmt::format("complete -c {} -n {} -f\n", program.name, before);
  text += fish_option(help_option, before, program.name);
  text += fmt::format("complete -c {} -n {} -l version -d 'Print the version and exit'\n", program.name, before);
  for (const Subcommand& command : program.commands)
    text += fmt::format("complete -c {} -n {} -f -a {} -d {}\n", program.name, before, command.name,
                        fish_quoted(command.about));
  for (const Subcommand& command : program.commands) {
    const std::string here = fish_quoted("__fish_seen_subcommand_from " + command.name);
    for (const Option& option : all_options(program, command)) text += fish_option(option, here, program.name);
  }
  return text;
}

Subcommand completion_command() {
  auto names = std::make_shared<std::vector<std::string>>();
  Subcommand command{.name = "completion"};
  command.footer =
      "Installed with the program, the scripts are found by the shells themselves.\n"
      "\nExamples: source <(mobil completion bash)\n"
      "          mobil completion zsh > ~/.zfunc/_mobil\n"
      "          mobil completion fish > ~/.config/fish/completions/mobil.fish";
  command.options = {{.name = "shell", .target = names.get(), .help = "bash, zsh or fish", .words = names_of(shells)}};
  command.run = [names] { return exit_status_of("completion", run_completion(*names)); };
  return command;
}

}  // namespace mobil
