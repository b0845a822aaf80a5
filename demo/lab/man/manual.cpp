#include "demo/lab/man/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "demo/program/commands.h"
#include "demo/program/console.h"
#include "demo/program/must.h"
#include "demo/program/named_entries.h"
#include "demo/program/program.h"
#include "demo/program/subcommands.h"
#include "demo/program/units.h"

namespace mobil {
namespace {

constexpr std::string_view exit_status =
    ".SH EXIT STATUS\n"
    "0: done. 1: it ran, but something that is promised did not hold, or requested output could not be written.\n"
    "2: bad usage or input; one line on standard error says what, and how to mend it.\n";

/// Returns the UTF-8 character that begins at `at`, and moves `at` behind it.
std::uint32_t code_point(std::string_view text, std::size_t& at) {
  const auto byte = [&] { return static_cast<unsigned char>(text[at++]); };
  const std::uint32_t first = byte();
  if (first < 0xC0) return first;
  std::size_t more = first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
  std::uint32_t code = first & (0x3FU >> more);
  for (; more > 0 && at < text.size(); --more) code = (code << 6U) | (byte() & 0x3FU);
  return code;
}

constexpr std::pair<char, std::string_view> escapes[] = {
    {'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}, {'"', "\\(dq"}};

/// Returns text for troff: its special characters are escaped, and hyphens are those of shells.
std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::uint32_t code = code_point(text, at);
    const auto escape =
        std::ranges::find_if(escapes, [&](const auto& one) { return one.first == static_cast<char>(code); });
    if (code >= 0x80) {
      out += fmt::format("\\[u{:04X}]", code);
    } else if (escape != std::end(escapes)) {
      out += escape->second;
    } else {
      out += static_cast<char>(code);
    }
  }
  return out;
}

/// Returns a line of text, which is not a request even if it begins with a full stop.
std::string text_line(std::string_view text) {
  const std::string line = plain(text);
  return (line.starts_with('.') ? "\\&" : "") + line + "\n";
}

std::string bold(std::string_view text) {
  return "\\fB" + plain(text) + "\\fR";
}

std::string option_text(const Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : split(option.name, ',')) names.push_back(bold(name));
  std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
  if (takes_value(option) && option.name.starts_with("-")) text += " \\fIVALUE\\fR";
  if (const std::string usual = default_value(option); !usual.empty()) text += " (" + plain(usual) + ")";
  text += "\n" + text_line(option.help);
  if (!option.choices.empty()) text += text_line(fmt::format("One of {}.", fmt::join(option.choices, ", ")));
  return text;
}

/// Returns options without a heading first, then by heading, in the order in which headings first occur.
std::string options_text(const std::vector<Option>& options, std::string_view heading_request) {
  std::vector<std::string> groups = {""};
  for (const Option& option : options)
    if (std::ranges::find(groups, option.group) == groups.end()) groups.push_back(option.group);
  std::string text;
  for (const std::string& group : groups) {
    if (!group.empty()) text += fmt::format("{}{}\n", heading_request, plain(group));
    for (const Option& option : options)
      if (option.group == group) text += option_text(option);
  }
  return text;
}

/// Returns the end of --help: running text is filled again, indented text is kept, examples come last.
std::string footer_text(const std::string& footer) {
  std::string notes, examples;
  bool as_it_is = false, in_examples = false;
  for (std::string line : split(footer, '\n')) {
    for (const std::string_view begin : {"Examples: ", "Example: "}) {
      if (!line.starts_with(begin)) continue;
      line = line.substr(begin.size());
      in_examples = true;
    }
    if (in_examples) {
      const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
      examples += text_line(line.substr(indent));
      continue;
    }
    const bool indented = line.starts_with(' ');
    if (indented != as_it_is) notes += indented ? ".nf\n" : ".fi\n";
    as_it_is = indented;
    notes += line.empty() ? ".PP\n" : text_line(line);
  }
  if (as_it_is) notes += ".fi\n";
  while (notes.ends_with(".PP\n")) notes.resize(notes.size() - 4);
  for (std::size_t at; (at = notes.find(".PP\n.nf\n")) != std::string::npos;) notes.replace(at, 4, "");
  return (notes.empty() ? "" : ".SH NOTES\n" + notes) +
         (examples.empty() ? "" : ".SH EXAMPLES\n.nf\n" + examples + ".fi\n");
}

std::string head(const Program& program, const std::string& page, std::string_view about) {
  std::string capital = page;
  std::ranges::transform(capital, capital.begin(), [](unsigned char c) { return std::toupper(c); });
  return fmt::format(
      ".\\\" Written by `{} man`. Do not edit.\n"
      ".TH {} 1 \"\" \"{} {}\" \"User commands\"\n.nh\n.ad l\n"
      ".SH NAME\n{} \\- {}\n",
      program.name, plain(capital), program.name, program.version, plain(page), plain(about));
}

std::string synopsis(const Program& program, const Subcommand& command) {
  std::string line = bold(program.name + " " + command.name) + " [\\fIOPTIONS\\fR]";
  for (const Option& option : command.options)
    if (!option.name.starts_with("-")) line += fmt::format(" [\\fI{}\\fR...]", plain(option.name));
  return line + "\n";
}

struct ManText {
  std::vector<std::string> pages;
  std::string out;
};

void write_pages(const Program& program, const std::vector<Subcommand>& commands, bool whole, const std::string& out) {
  auto results = OutputFolder::make(out);
  if (!results) throw Stopped("--out " + results.error().message);
  const auto page = [&](const std::string& name, const std::string& text) {
    return write_file(results->inside() / (name + ".1"), text);
  };
  if (whole) must(page(program.name, manual(program)));
  for (const Subcommand& command : commands) must(page(program.name + "-" + command.name, manual(program, command)));
  must(results->put());
  say_written(out);
}

void run_man(const ManText& text) {
  const Program program = mobil_program();
  const auto chosen = must(choose_named(program.commands, text.pages, "page of"));
  if (!text.out.empty()) return write_pages(program, chosen, text.pages.empty(), text.out);
  if (text.pages.empty()) write_output(manual(program));
  for (const std::string& name : text.pages) {
    const auto command = std::ranges::find(chosen, name, &Subcommand::name);
    write_output(manual(program, *command));
  }
}

}  // namespace

std::string manual(const Program& program) {
  // "name: what it is.\nMore"
  const std::size_t line_end = std::min(program.about.find('\n'), program.about.size());
  std::string about = program.about.substr(0, line_end);
  if (about.starts_with(program.name + ": ")) about = about.substr(program.name.size() + 2);
  if (about.ends_with('.')) about.pop_back();
  std::string text = head(program, program.name, about);
  text += ".SH SYNOPSIS\n" + bold(program.name) + " \\fISUBCOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n";
  for (const std::string& line : split(program.about.substr(line_end), '\n'))
    if (!line.empty()) text += text_line(line);
  text += ".SH OPTIONS\n" + option_text(help_option) + ".TP\n" + bold("--version") + "\nPrint the version and exit\n";
  text += ".SH SUBCOMMANDS\n";
  std::string pages;
  for (const Subcommand& command : program.commands) {
    text += ".SS " + plain(command.name) + "\n" + text_line(command.about + ".") + ".PP\n" + synopsis(program, command);
    text += options_text(all_options(program, command), ".PP\n");
    pages += fmt::format(".BR {} (1){}\n", plain(program.name + "-" + command.name),
                         &command == &program.commands.back() ? "" : " ,");
  }
  return text + std::string(exit_status) + footer_text(program.footer) + ".SH SEE ALSO\n" + pages;
}

std::string manual(const Program& program, const Subcommand& command) {
  return head(program, program.name + "-" + command.name, command.about) + ".SH SYNOPSIS\n" +
         synopsis(program, command) + ".SH OPTIONS\n" + options_text(all_options(program, command), ".SS ") +
         footer_text(command.footer) + std::string(exit_status) + ".SH SEE ALSO\n.BR " + plain(program.name) + " (1)\n";
}

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
  command.run = [text] { return exit_status_of("man", attempt([&] { run_man(*text); })); };
  return command;
}

}  // namespace mobil
