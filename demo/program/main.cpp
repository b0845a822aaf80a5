// `mobil`, `mobil-crowd` and `mobil-lab`: the face of the library for people and for scripts.
// Exit status: 0 done, or nobody reads what is printed any more (`| head`); 1 ran but did not hold, or standard output
// could not be written; 2 bad usage or input (one line on stderr says what and how to mend it).

#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "demo/program/commands.h"
#include "demo/program/program.h"

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
  return finish(mobil::run_own(MOBIL_NAME, mobil::MOBIL_COMMANDS(), argc, argv));
}
