// `mobil man`: pages of the manual.

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "demo/lab/man/manual.h"
#include "demo/program/commands.h"
#include "demo/program/named_entries.h"
#include "demo/program/program.h"
#include "demo/program/subcommands.h"

namespace mobil {
namespace {

struct ManText {
  std::vector<std::string> pages;
  std::string out;
};

Result<void> write_pages(const Program& program, const std::vector<Subcommand>& commands, bool whole,
                         const std::string& out) {
  auto results = OutputFolder::make(out);
  if (!results) return fail("--out " + results.error().message);
  const auto page = [&](const std::string& name, const std::string& text) {
    return write_file(results->inside() / (name + ".1"), text);
  };
  if (whole) {
    if (auto done = page(program.name, manual(program)); !done) return done;
  }
  for (const Subcommand& command : commands) {
    if (auto done = page(program.name + "-" + command.name, manual(program, command)); !done) return done;
  }
  if (auto done = results->put(); !done) return done;
  say_written(out);
  return {};
}

Result<void> run_man(const ManText& text) {
  const Program program = mobil_program();
  const auto chosen = choose_named(program.commands, text.pages, "page of");
  if (!chosen) return tl::unexpected(chosen.error());
  if (!text.out.empty()) return write_pages(program, *chosen, text.pages.empty(), text.out);
  if (text.pages.empty()) fmt::print("{}", manual(program));
  for (const std::string& name : text.pages) {
    const auto command = std::ranges::find(*chosen, name, &Subcommand::name);
    fmt::print("{}", manual(program, *command));
  }
  return {};
}

}  // namespace

Subcommand man_command() {
  auto text = std::make_shared<ManText>();
  Subcommand command{.name = "man"};
  command.footer =
      "Installed with the program, they are read by man mobil, man mobil-walk and the like.\n"
      "\nExamples: mobil man walk | man -l -\n"
      "          mobil man --out share/man/man1";
  command.options = {{.name = "subcommand",
                      .target = &text->pages,
                      .help = "Whose page; that of the whole program by default",
                      .words = names_of(subcommand_rows())},
                     {"--out", &text->out, "Folder for the pages as files, of all subcommands where none is named"}};
  command.empty_refused = true;
  command.run = [text] { return exit_status_of("man", run_man(*text)); };
  return command;
}

}  // namespace mobil
