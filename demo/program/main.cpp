// The `mobil` program: the face of the library for people and for scripts.
// Exit status: 0 done, 1 ran but did not hold, or standard output could not be written, 2 bad usage or input (one line
// on stderr says what and how to mend it).

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "demo/program/commands.h"
#include "demo/program/usage.h"

namespace {

/// What was printed may still be in a buffer: only now is it known whether it reached anybody.
int finish(int status) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || status != 0) return status;
  std::fputs("mobil: standard output cannot be written (full, or closed); redirect it elsewhere\n", stderr);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "mobil: crowds of virtual humans who walk, and whose muscles deform as they do.\n"
      "Body and gait parameters go in; a walking skeleton, its lines of action, finite-element muscles and anatomical\n"
      "surfaces come out. Quantities are SI or carry a unit: 180cm, 5km/h, 110steps/min.",
      "mobil"};
  app.set_version_flag("--version", "mobil 0.1.0");
  app.require_subcommand(1);

  int status = 0;
  mobil::add_walk_command(app, status);
  mobil::add_muscle_command(app, status);
  mobil::add_body_command(app, status);
  mobil::add_bench_command(app, status);
  mobil::add_compare_command(app, status);
  mobil::add_stress_command(app, status);
  mobil::add_paper_command(app, status);
  mobil::add_frontier_command(app, status);
  mobil::add_effects_command(app, status);
  mobil::add_crowd_command(app, status);
  app.footer("Example: mobil walk --height 1.80 --mass 80 --speed 5km/h --video --out out");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool unknown_subcommand = app.get_subcommands().empty() && !app.remaining().empty();
    if (error.get_exit_code() == 0 && !unknown_subcommand) return finish(app.exit(error));  // --help, --version
    std::fputs(mobil::explain_usage(app, error, argc, argv).c_str(), stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("mobil: {}\n", error.what()).c_str(), stderr);
    return 1;
  }
  return finish(status);
}
