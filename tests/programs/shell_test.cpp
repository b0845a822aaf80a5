// Completions and manual pages are made from the tables of the command line: they contain every option of every
// subcommand, and shells and troff accept them. Progress and --quiet.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "demo/lab/completion/completion.h"
#include "demo/lab/man/manual.h"
#include "demo/program/program.h"
#include "demo/program/progress.h"
#include "demo/program/units.h"
#include "tests/program/program.h"

namespace mobil::shell_test {

bool is_there(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

/// Returns the names of a subcommand's options, including dashes, without positional arguments.
std::vector<std::string> option_names(const Program& program, const Subcommand& command) {
  std::vector<std::string> names = {"-h", "--help"};
  for (const auto* options : {&command.options, &program.options})
    for (const Option& option : *options)
      if (option.name.starts_with("-")) names.push_back(option.name);
  return names;
}

/// Expects each name in the text as a complete word.
void expect_all(const std::string& text, const std::vector<std::string>& names, const std::string& where) {
  for (const std::string& name : names) {
    std::size_t at = text.find(name);
    const auto goes_on = [&] {
      const std::size_t end = at + name.size();
      return end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '-');
    };
    while (at != std::string::npos && goes_on()) at = text.find(name, at + 1);
    EXPECT_NE(at, std::string::npos) << where << " lacks " << name;
  }
}

/// Returns the words that bash offers for the last of `words`, sorted.
std::vector<std::string> bash_offers(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "mobil.bash") << bash_completion(mobil_program());
  std::string line;
  for (const std::string& word : words) line += fmt::format("\"{}\" ", word);
  const Ran ran = run_shell(fmt::format("bash -c 'set -u; source mobil.bash; COMP_WORDS=({}); COMP_CWORD={}; _mobil; "
                                        "printf \"%s\\n\" \"${{COMPREPLY[@]}}\"'",
                                        line, words.size() - 1),
                            folder.path);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  std::vector<std::string> offers;
  for (const std::string& offer : split(ran.out, '\n'))
    if (!offer.empty()) offers.push_back(offer);
  std::ranges::sort(offers);
  return offers;
}

using Words = std::vector<std::string>;

TEST(Completion, BashOffersSubcommandsOptionsAndValues) {
  if (!is_there("bash")) GTEST_SKIP() << "no bash";
  EXPECT_EQ(bash_offers({"mobil", "wa"}), Words{"walk"});
  EXPECT_EQ(bash_offers({"mobil", "--ver"}), Words{"--version"});
  EXPECT_EQ(bash_offers({"mobil", "walk", "--step-"}), (Words{"--step-frequency", "--step-length"}));
  EXPECT_EQ(bash_offers({"mobil", "walk", "--qu"}), Words{"--quiet"});
  EXPECT_EQ(bash_offers({"mobil", "walk", "--constitution", "a"}), (Words{"athletic", "average"}));
  EXPECT_EQ(bash_offers({"mobil", "walk", "--constitution", "=", "a"}), (Words{"athletic", "average"}));
  EXPECT_EQ(bash_offers({"mobil", "frontier", "--loads", "=l"}), Words{}) << "= is a word of its own to bash";
  EXPECT_EQ(bash_offers({"mobil", "frontier", "--loads", "="}), (Words{"both", "frame", "line"}));
  EXPECT_EQ(bash_offers({"mobil", "bench", "gait", "kine"}), Words{"kinematics"});
  EXPECT_EQ(bash_offers({"mobil", "completion", "f"}), Words{"fish"});
  EXPECT_EQ(bash_offers({"mobil", "man", "cro"}), Words{"crowd"});
  EXPECT_EQ(bash_offers({"mobil", "walk", "--script", "t"}), Words{}) << "files are for bash to offer";
}

TEST(Completion, BashOffersEveryOptionOfEverySubcommand) {
  if (!is_there("bash")) GTEST_SKIP() << "no bash";
  const Program program = mobil_program();
  std::vector<std::string> names = {"--help", "--version", "-h"};
  for (const Subcommand& command : program.commands) names.push_back(command.name);
  std::vector<std::string> offered = bash_offers({"mobil", "-"});
  std::ranges::move(bash_offers({"mobil", ""}), std::back_inserter(offered));
  for (const std::string& name : names) EXPECT_TRUE(std::ranges::count(offered, name) > 0) << name;
  for (const Subcommand& command : program.commands) {
    std::vector<std::string> options = option_names(program, command);
    options.erase(std::ranges::find(options, "-h"));
    options.push_back("-h");
    std::ranges::sort(options);
    EXPECT_EQ(bash_offers({"mobil", command.name, "-"}), options) << command.name;
  }
}

TEST(Completion, OtherShellsHaveEveryOptionAndAcceptTheScript) {
  const Program program = mobil_program();
  const TemporaryFolder folder;
  const std::string zsh = zsh_completion(program), fish = fish_completion(program);
  for (const Subcommand& command : program.commands) {
    const std::size_t begin = zsh.find("        " + command.name + ")\n");
    ASSERT_NE(begin, std::string::npos) << command.name;
    expect_all(zsh.substr(begin, zsh.find(";;", begin) - begin), option_names(program, command), "zsh " + command.name);
    for (std::string name : option_names(program, command)) {
      name = name.starts_with("--") ? " -l " + name.substr(2) + " " : " -s " + name.substr(1) + " ";
      bool found = false;
      for (const std::string& line : split(fish, '\n'))
        found |= line.find("from " + command.name + "'") != std::string::npos && line.find(name) != std::string::npos;
      EXPECT_TRUE(found) << command.name << name;
    }
  }
  std::ofstream(folder.path / "_mobil") << zsh;
  std::ofstream(folder.path / "mobil.fish") << fish;
  if (is_there("zsh")) {
    const Ran ran = run_shell("zsh -n _mobil", folder.path);
    EXPECT_EQ(ran.status, 0) << ran.err;
  }
  if (is_there("fish")) {
    const Ran ran = run_shell("fish --private -c 'source mobil.fish; complete -C \"mobil walk --const\"'", folder.path);
    EXPECT_TRUE(ran.out.starts_with("--constitution\t")) << ran.out << ran.err;
  }
}

TEST(Completion, TheProgramPrintsItsScripts) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_mobil("completion bash", folder.path).out, bash_completion(mobil_program()));
  EXPECT_EQ(run_mobil("completion zsh", folder.path).out, zsh_completion(mobil_program()));
  EXPECT_EQ(run_mobil("completion fish", folder.path).out, fish_completion(mobil_program()));
  expect_refused("completion", {{"", {"bash, zsh or fish"}}, {"bahs", {"did you mean bash?"}}}, folder.path);
}

/// Returns troff text without font changes and other escapes.
std::string without_escapes(std::string text) {
  for (const char* font : {"\\fB", "\\fI", "\\fR"})
    for (std::size_t at; (at = text.find(font)) != std::string::npos;) text.replace(at, 3, " ");
  std::erase(text, '\\');
  return text;
}

TEST(Manual, HasEveryOptionOfEverySubcommand) {
  const Program program = mobil_program();
  const std::string whole = without_escapes(manual(program));
  for (std::size_t c = 0; c < program.commands.size(); ++c) {
    const Subcommand& command = program.commands[c];
    const auto names = option_names(program, command);
    const std::size_t begin = whole.find(".SS " + command.name + "\n");
    ASSERT_NE(begin, std::string::npos) << command.name;
    const std::size_t end = whole.find(c + 1 < program.commands.size() ? "\n.SS " : "\n.SH ", begin);
    expect_all(whole.substr(begin, end - begin), names, "mobil(1), " + command.name);
    expect_all(without_escapes(manual(program, command)), names, "mobil-" + command.name + "(1)");
  }
  const TemporaryFolder folder;
  EXPECT_EQ(run_mobil("man", folder.path).out, manual(program));
  EXPECT_EQ(run_mobil("man walk", folder.path).out, manual(program, program.commands.front()));
  expect_refused("man", {{"walj", {"'walj'", "did you mean walk?"}}}, folder.path);
}

TEST(Manual, TroffAcceptsItWithoutWarnings) {
  if (!is_there("groff")) GTEST_SKIP() << "no groff";
  const TemporaryFolder folder;
  const Ran written = run_mobil("man --out pages", folder.path);
  EXPECT_EQ(written.out, "written pages\n");
  std::size_t pages = 0;
  for (const auto& page : std::filesystem::directory_iterator(folder.path / "pages")) {
    const std::string text = read_bytes(page.path());
    EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; })) << page.path();
    const Ran ran = run_shell(fmt::format("groff -ww -b -man -Tutf8 -rLL=80n '{}'", page.path().string()), folder.path);
    EXPECT_EQ(ran.status, 0);
    EXPECT_EQ(ran.err, "") << page.path();
    EXPECT_NE(ran.out.find("bad usage or input"), std::string::npos);
    ++pages;
  }
  EXPECT_EQ(pages, mobil_program().commands.size() + 1);
}

TEST(Quiet, WrittenFilesAreNotReported) {
  const TemporaryFolder folder;
  for (const std::string arguments :
       {"muscle --seconds 0.01", "body --out out", "walk --seconds 0.1 --out out", "man --out pages",
        "crowd --people 4 --seconds 0.1 --effects none --report crowd.json", "stress nan --quick --json stress.json"}) {
    const Ran told = run_mobil(arguments, folder.path), quiet = run_mobil(arguments + " --quiet", folder.path);
    EXPECT_EQ(quiet.status, told.status) << arguments;
    const auto says_where = [](const Ran& ran) {
      return ran.out.find("written ") != std::string::npos || ran.out.find("look at ") != std::string::npos;
    };
    EXPECT_TRUE(says_where(told)) << arguments << ": " << told.out << told.err;
    EXPECT_FALSE(says_where(quiet)) << quiet.out;
    EXPECT_FALSE(quiet.out.starts_with("\n")) << arguments;
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path / "stress.json"));
  EXPECT_EQ(run_mobil("stress nan --quick --quiet", folder.path).out.find("held  nan"), std::size_t{0})
      << "results are not progress";
  const Ran refused = run_mobil("walk --quiet --height 9", folder.path);
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("--height 9"), std::string::npos) << "errors stay";
}

TEST(Progress, PlainLinesAreTenSecondsApart) {
  LinePace pace;
  std::vector<double> due;
  for (double t = 100; t < 141; t += 0.25)
    if (pace.due(t)) due.push_back(t);
  EXPECT_EQ(due, (std::vector<double>{110, 120, 130, 140}));
  EXPECT_TRUE(pace.due(1000));
  EXPECT_FALSE(pace.due(1001)) << "a long silence is no credit";
}

TEST(Progress, ShortRunsPrintNothingWithoutATerminal) {
  testing::internal::CaptureStderr();
  show("measuring");
  for (std::size_t i = 0; i < 5; ++i) show_progress("spawning", i, 5);
  show_part("costs", 0.5);
  show("");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const TemporaryFolder folder;
  EXPECT_EQ(run_mobil("crowd --people 8 --seconds 0.1 --effects none", folder.path).err, "");
}

/// Runs on a pseudo-terminal. Returns its output.
std::string on_terminal(const std::string& arguments, const TemporaryFolder& folder) {
  return run_shell("script -qec \"'" MOBIL_PROGRAM "' " + arguments + "\" /dev/null", folder.path).out;
}

TEST(Progress, ATerminalShowsALineUnlessQuiet) {
  if (!is_there("script")) GTEST_SKIP() << "no script(1) to make a terminal";
  const TemporaryFolder folder;
  const std::string arguments = "crowd --people 8 --seconds 0.1 --effects none";
  EXPECT_NE(on_terminal(arguments, folder).find("spawning ["), std::string::npos);
  EXPECT_EQ(on_terminal(arguments + " --quiet", folder).find("spawning"), std::string::npos);
}

}  // namespace mobil::shell_test
