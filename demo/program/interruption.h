#pragma once
// Ctrl-C, `kill` and closed pipes.

namespace mobil {

/// To be called first in main, before any thread is started. Interrupted (SIGINT, SIGTERM, SIGHUP), the program removes
/// what is not complete, ends the programs that it has started, and dies of the signal, as callers expect. Writing into
/// a pipe that nobody reads any more fails with EPIPE instead of killing the program.
void handle_interruption();

}  // namespace mobil
