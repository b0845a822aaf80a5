// `mobil completion`: scripts that teach a shell the program's options.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "demo/lab/completion/completion.h"
#include "demo/program/commands.h"
#include "demo/program/named_entries.h"
#include "demo/program/program.h"

namespace mobil {
namespace {

struct Shell {
  std::string_view name;
  std::string (*script)(const Program&);
};

const std::vector<Shell> shells = {{"bash", &bash_completion}, {"zsh", &zsh_completion}, {"fish", &fish_completion}};

Result<void> run_completion(const std::vector<std::string>& names) {
  const auto chosen = choose_named(shells, names, "shell");
  if (!chosen) return tl::unexpected(chosen.error());
  if (names.size() != 1) return fail("name one shell: mobil completion bash, zsh or fish");
  fmt::print("{}", chosen->front().script(mobil_program()));
  return {};
}

}  // namespace

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
