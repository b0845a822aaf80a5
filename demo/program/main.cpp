// The `mobil` program: the face of the library for people and for scripts.
// Exit status: 0 done, or nobody reads what is printed any more (`| head`); 1 ran but did not hold, or standard output
// could not be written; 2 bad usage or input (one line on stderr says what and how to mend it).

#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "demo/program/commands.h"
#include "demo/program/interruption.h"

namespace {

/// Of a pipe: the other end is closed.
bool nobody_reads_stdout() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

/// What was printed may still be in a buffer: only now is it known whether it reached anybody.
int finish(int status) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || status != 0 || nobody_reads_stdout()) return status;
  std::fputs("mobil: standard output cannot be written (full, or closed); redirect it elsewhere\n", stderr);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  mobil::handle_interruption();
  const mobil::Program program = {
      .name = "mobil",
      .about =
          "mobil: crowds of virtual humans who walk, and whose muscles deform as they do.\n"
          "Body and gait parameters go in; a walking skeleton, its lines of action, finite-element muscles and "
          "anatomical\n"
          "surfaces come out. Quantities are SI or carry a unit: 180cm, 5km/h, 110steps/min.",
      .version = MOBIL_VERSION,
      .footer = "Example: mobil walk --height 1.80 --mass 80 --speed 5km/h --video --out out",
      .commands = {mobil::walk_command(), mobil::muscle_command(), mobil::body_command(), mobil::anatomy_command(),
                   mobil::bench_command(), mobil::compare_command(), mobil::stress_command(), mobil::paper_command(),
                   mobil::frontier_command(), mobil::effects_command(), mobil::crowd_command(), mobil::view_command(),
                   mobil::bake_command(), mobil::gait_fit_command()}};
  return finish(mobil::run_program(program, argc, argv));
}
