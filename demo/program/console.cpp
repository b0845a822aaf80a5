#include "demo/program/console.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>

namespace mobil {
namespace {

constexpr int error_wait_ms = 1000, output_wait_ms = -1;

std::atomic<bool> output_failed{false};

/// Writes all of the text. Returns 0 or an errno. A descriptor of another process can be non-blocking: then it waits.
int write_all(int descriptor, std::string_view text, int wait_ms) noexcept {
  while (!text.empty()) {
    const auto written = ::write(descriptor, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return errno;
    pollfd ready{descriptor, POLLOUT, 0};
    if (::poll(&ready, 1, wait_ms) == 0) return EAGAIN;
  }
  return 0;
}

}  // namespace

void prepare_streams() noexcept {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    // For reading only: output must fail as it does on a closed descriptor. The lowest free number is the result.
    if (::fcntl(descriptor, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) < 0) return;
  }
}

void write_error(std::string_view text) noexcept {
  write_all(STDERR_FILENO, text, error_wait_ms);
}

void write_note(std::string_view text) noexcept {
  write_all(STDOUT_FILENO, text, output_wait_ms);
}

void write_output(std::string_view text) noexcept {
  const int error = write_all(STDOUT_FILENO, text, output_wait_ms);
  if (error != 0 && error != EPIPE) output_failed = true;
}

int output_status(int status) noexcept {
  if (status != 0 || !output_failed) return status;
  print_error("mobil: standard output cannot be written (full, or closed); redirect it elsewhere");
  return 1;
}

}  // namespace mobil
