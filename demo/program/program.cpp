#include "demo/program/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string>

#include <mobil/version.h>

#include "demo/program/console.h"
#include "demo/program/interruption.h"
#include "demo/program/progress.h"
#include "demo/program/subcommands.h"

namespace mobil {
namespace {

/// Returns the program that runs a subcommand. Only mobil-crowd reads real meshes, so it runs `walk --anatomy`.
std::string_view program_of(const SubcommandRow& row, std::span<const std::string> arguments) {
  const bool meshes = row.name == "walk" && std::ranges::any_of(arguments, [](const std::string& argument) {
                        return argument.starts_with("--anatomy");
                      });
  return meshes ? "mobil-crowd" : row.program;
}

/// Replaces this process by another program. Returns only if that is not built.
int run_beside(const SubcommandRow& row, std::string_view program, char** argv) {
  std::error_code none;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  execv((folder / program).c_str(), argv);
  std::string target(program == "mobil" ? "mobil_program" : program);
  std::ranges::replace(target, '-', '_');
  print_error("mobil: '{}' is a subcommand of {}, which is not in the folder of this program; build it: cmake --build "
             "build/release --target {}",
             row.name, program, target);
  return 2;
}

struct FormerWord {
  std::string_view option, was, is;  // values of `option`, or options if `option` is empty
};
constexpr std::array former_words = {
    FormerWord{"", "--humans", "--people"},
    FormerWord{"", "--members", "--muscles=all"},
    FormerWord{"", "--vectors", "--modes"},
    FormerWord{"--method", "ecd", "explicit-central"},
    FormerWord{"--method", "icd", "implicit-central"},
    FormerWord{"--method", "caa", "newmark"},
    FormerWord{"--method", "reduced", "modal"},
};

/// Replaces former words in `--name VALUE` and `--name=VALUE`, and `crowd --alive N` by `city --people N`. To be
/// removed in 0.5.
void replace_former_words(std::vector<std::string>& arguments) {
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    std::string& argument = arguments[i];
    const std::size_t end = argument.starts_with("--") ? std::min(argument.find('='), argument.size()) : 0;
    if (i > 1 && arguments[1] == "crowd" && argument.substr(0, end) == "--alive") {
      arguments[1] = "city";
      argument.replace(0, end, "--people");
    }
    for (const auto& [option, was, is] : former_words) {
      std::size_t from = 0, to = argument.size();
      if (option.empty())
        to = end;
      else if (end < argument.size() && argument.substr(0, end) == option)
        from = end + 1;
      else if (arguments[i - 1] != option)
        continue;
      if (argument.substr(from, to - from) != was) continue;
      print_error("mobil: '{}' is deprecated; use '{}'", was, is);
      argument.replace(from, to - from, is);
    }
  }
}

}  // namespace

Result<Program> make_program(std::string_view name, std::vector<Subcommand> commands) {
  Program program = {
      .name = "mobil",
      .about =
          "mobil: crowds of walking virtual humans with finite-element muscles.\n"
          "From body and gait parameters it computes walking skeletons, lines of action, deforming muscles and\n"
          "anatomical surfaces. Quantities are SI or carry a unit: 180cm, 5km/h, 110steps/min.",
      .version = MOBIL_VERSION,
      .footer = "Example: mobil walk --height 1.80 --mass 80 --speed 5km/h --video --out out",
      .options = {{"--quiet", &quiet, "Print no progress and no names of written files; errors stay"}}};
  for (const SubcommandRow& row : subcommand_rows()) {
    const auto own = std::ranges::find(commands, row.name, &Subcommand::name);
    Subcommand command{.name = std::string(row.name)};
    if (own != commands.end()) {
      command = std::move(*own);
      commands.erase(own);
    } else if (name.empty() || row.program == name) {
      return fail(fmt::format("'{}' is only in the table", row.name));
    }
    command.about = row.help;
    command.program = row.program;
    program.commands.push_back(std::move(command));
  }
  if (!commands.empty()) return fail(fmt::format("the table lacks '{}' for this program", commands.front().name));
  return program;
}

int run_own(std::string_view name, std::vector<Subcommand> commands, int argc, char** argv) {
  std::vector<std::string> arguments(argv, argv + argc);
  if (const auto* row = argc > 1 ? find_subcommand(arguments[1]) : nullptr) {
    const std::string_view program = program_of(*row, arguments);
    if (program != name) return run_beside(*row, program, argv);
    arguments[1] = row->name;
  }
  replace_former_words(arguments);
  handle_interruption();  // after run_beside, because another program would inherit blocked signals
  const auto program = make_program(name, std::move(commands));
  if (!program) {
    print_error("{}: subcommands differ from demo/program/subcommands.cpp: {}", name, program.error().message);
    return 2;
  }
  std::vector<const char*> texts;
  for (const std::string& argument : arguments) texts.push_back(argument.c_str());
  texts.push_back(nullptr);
  return run_program(*program, argc, texts.data());
}

}  // namespace mobil
