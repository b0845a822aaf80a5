#pragma once
// Ctrl-C, `kill`, a closed terminal and a limit of processor time.

namespace mobil {

/// Must be called before any thread is started. On SIGINT, SIGTERM, SIGHUP, SIGQUIT or SIGXCPU the program removes
/// incomplete files, ends the programs that it has started, and dies of the signal, as callers expect.
void handle_interruption();

}  // namespace mobil
