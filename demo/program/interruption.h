#pragma once
// Ctrl-C, `kill` and closed pipes.

namespace mobil {

/// Must be called first in main, before any thread is started. On SIGINT, SIGTERM or SIGHUP the program removes
/// incomplete files, ends the programs that it has started, and dies of the signal, as callers expect. Writing to a
/// closed pipe fails with EPIPE instead of killing the program.
void handle_interruption();

}  // namespace mobil
