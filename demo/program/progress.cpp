#include "demo/program/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace mobil {
namespace {

constexpr std::size_t bar_width = 40;
constexpr double first_s = 1, between_s = 0.1;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

bool on_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

void show(std::string_view line) {
  if (!on_terminal()) return;
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
}

void show_part(std::string_view what, double part) {
  if (on_terminal()) show(fmt::format("{} {:.0f} %", what, 100 * part));
}

void show_progress(std::string_view what, std::size_t done, std::size_t of) {
  if (!on_terminal()) return;
  show(fmt::format("{} [{:<{}}] {}/{}", what, std::string(bar_width * done / of, '='), bar_width, done, of));
}

ProgressBar::ProgressBar(std::string_view what, std::size_t of)
    : what_(what), of_(of), next_s_(now_s() + first_s), terminal_(on_terminal()) {}

ProgressBar::~ProgressBar() {
  if (shown_) show("");
}

void ProgressBar::at(std::size_t done) {
  if (!terminal_) return;
  const double now = now_s();
  if (now < next_s_) return;
  next_s_ = now + between_s;
  shown_ = true;
  show_progress(what_, done, of_);
}

}  // namespace mobil
