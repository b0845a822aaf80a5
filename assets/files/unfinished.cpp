#include "assets/files/unfinished.h"

#include <sys/wait.h>

#include <csignal>
#include <map>
#include <set>
#include <system_error>

namespace mobil::inline v0_3 {
namespace {

struct Register {
  std::recursive_mutex mutex;
  std::map<std::filesystem::path, std::filesystem::path> made_of;
  std::set<pid_t> process;
};

/// Never destroyed, because other threads can still write when main returns.
Register& unfinished() {
  static auto& made = *new Register;
  return made;
}

}  // namespace

void note_unfinished(const std::filesystem::path& path, const std::filesystem::path& made) {
  const auto hold = hold_unfinished();
  unfinished().made_of[path] = made;
}

void forget_unfinished(const std::filesystem::path& path) {
  const auto hold = hold_unfinished();
  unfinished().made_of.erase(path);
}

void note_started(pid_t process) {
  const auto hold = hold_unfinished();
  unfinished().process.insert(process);
}

void forget_started(pid_t process) {
  const auto hold = hold_unfinished();
  unfinished().process.erase(process);
}

void remove_with_folders(const std::filesystem::path& path, const std::filesystem::path& made) noexcept {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (made.empty()) return;
  auto at = path;
  do {
    at = at.parent_path();
    std::filesystem::remove(at, error);  // fails if it is missing or not empty
  } while (at != made && at.has_relative_path());
}

std::unique_lock<std::recursive_mutex> hold_unfinished() {
  return std::unique_lock(unfinished().mutex);
}

void remove_unfinished() noexcept {
  unfinished().mutex.lock();
  for (const pid_t process : unfinished().process) {
    ::kill(process, SIGKILL);
    siginfo_t ended{};
    ::waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOWAIT);  // until then it can still create files
  }
  for (const auto& [path, made] : unfinished().made_of) {
    // Under another name no thread finds it to create more files in it, which would keep it.
    auto away = path;
    away += ".removed";
    std::error_code error;
    std::filesystem::rename(path, away, error);
    remove_with_folders(error ? path : away, made);
  }
}

}  // namespace mobil::inline v0_3
