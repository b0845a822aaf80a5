#include "demo/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <mutex>
#include <string>

#include "demo/program/console.h"

namespace mobil {
namespace {

constexpr std::size_t bar_width = 40;
constexpr double first_s = 1, between_s = 0.1, plain_between_s = 10;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool on_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

}  // namespace

bool LinePace::due(double now_s) {
  if (next_s_ && now_s < *next_s_) return false;
  const bool first = !next_s_;
  next_s_ = now_s + plain_between_s;
  return !first;
}

void show(std::string_view line) {
  static std::mutex one_at_a_time;
  static LinePace pace;
  if (quiet) return;
  const std::lock_guard lock(one_at_a_time);
  if (on_terminal()) {
    write_error(fmt::format("\r\033[K{}", line));
  } else if (!line.empty() && pace.due(now_s())) {
    print_error("{}", line);
  }
}

void show_part(std::string_view what, double part) {
  if (!quiet) show(fmt::format("{} {:.0f} %", what, 100 * part));
}

void show_progress(std::string_view what, std::size_t done, std::size_t of) {
  if (quiet) return;
  const std::string bar =
      on_terminal() ? fmt::format("[{:<{}}] ", std::string(bar_width * done / of, '='), bar_width) : std::string();
  show(fmt::format("{} {}{}/{}", what, bar, done, of));
}

ProgressBar::ProgressBar(std::string_view what, std::size_t of) : what_(what), of_(of), next_s_(now_s() + first_s) {}

ProgressBar::~ProgressBar() {
  if (shown_) show("");
}

void ProgressBar::at(std::size_t done) {
  if (quiet) return;
  const double now = now_s();
  if (now < next_s_) return;
  next_s_ = now + between_s;
  shown_ = true;
  show_progress(what_, done, of_);
}

}  // namespace mobil
