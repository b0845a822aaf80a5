// `mobil`, `mobil-crowd` and `mobil-lab`, the command-line interface of the library.
// Exit status: 0 done, or the reader of stdout has gone (`| head`); 1 a bound did not hold, or standard output could
// not be written; 2 bad usage or input (one line on stderr with cause and remedy).

#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include "demo/program/commands.h"
#include "demo/program/program.h"

namespace {

/// Returns true if stdout is a pipe whose other end is closed.
bool nobody_reads_stdout() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

/// Flushes stdout, which can fail for output that is still buffered, and returns the exit status.
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
