#include "demo/program/interruption.h"

#include <csignal>
#include <thread>

#include <mobil/assets/files/output_file.h>

namespace mobil {

void handle_interruption() {
  static sigset_t signals;
  sigemptyset(&signals);
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU}) {
    struct sigaction now {};
    if (sigaction(s, nullptr, &now) == 0 && now.sa_handler == SIG_IGN) continue;  // ignored, as under nohup
    sigaddset(&signals, s);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // inherited by all threads started later
  // A thread instead of a signal handler, because removing folders allocates.
  std::thread([] {
    int signal = 0;
    if (sigwait(&signals, &signal) != 0) return;
    remove_unfinished();
    std::signal(signal, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    raise(signal);
  }).detach();
}

}  // namespace mobil
