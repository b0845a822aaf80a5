#include "assets/import/mesh_gltf.h"

#include <fmt/format.h>

#include "assets/import/mesh_join.h"
#include "assets/import/mesh_text.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>

#include "assets/import/gltf_scene.h"

namespace mobil::inline v0_3 {
namespace {

constexpr rlim_t processor_s = 10, memory_bytes = 2'000'000'000;
constexpr std::chrono::seconds wall_limit{15};
constexpr std::size_t max_words = 3 * max_mesh_triangles, max_line = 400;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limit_memory = false;  // sanitizers reserve terabytes of addresses
#else
constexpr bool limit_memory = true;
#endif

/// First message of the child: counts of positions and indices of a mesh, or of characters of a line.
struct Answer {
  std::uint64_t positions = 0, indices = 0, line = 0;
};

// ------------------------------------------------------------------------------------------------------- the child

/// Returns the addresses in use, which a child has from its parent; 0 if the system does not report them.
rlim_t addresses_now() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r"); file != nullptr) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void set_limit(decltype(RLIMIT_CPU) what, rlim_t most) {
  const rlimit limit{most, most};
  ::setrlimit(what, &limit);
}

void confine() {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE, SIGTERM, SIGINT}) {
    std::signal(signal, SIG_DFL);
  }
  if (const int nowhere = ::open("/dev/null", O_WRONLY); nowhere >= 0) {
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
  }
  set_limit(RLIMIT_CPU, processor_s);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  if (limit_memory) set_limit(RLIMIT_AS, addresses_now() + memory_bytes);
}

void send(int pipe, const void* data, std::size_t bytes) {
  const auto* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const auto sent = ::write(pipe, from, bytes);
    if (sent <= 0) ::_exit(1);
    from += sent;
    bytes -= static_cast<std::size_t>(sent);
  }
}

[[noreturn]] void be_child(const std::string& path, int pipe) try {
  confine();
  const auto raw = read_gltf_scene(path);
  Answer answer;
  if (raw) {
    answer.positions = raw->position.size();
    answer.indices = raw->triangle.size();
    send(pipe, &answer, sizeof answer);
    send(pipe, raw->position.data(), raw->position.size() * sizeof raw->position[0]);
    send(pipe, raw->triangle.data(), raw->triangle.size() * sizeof raw->triangle[0]);
  } else {
    const auto line = raw.error().message.substr(0, max_line);
    answer.line = line.size();
    send(pipe, &answer, sizeof answer);
    send(pipe, line.data(), line.size());
  }
  ::_exit(0);
} catch (...) {
  ::_exit(1);
}

// ------------------------------------------------------------------------------------------------------ the parent

using Clock = std::chrono::steady_clock;

enum class Received { all, less, late };

/// Receives exactly so many bytes before `end`.
Received receive(int pipe, void* data, std::size_t bytes, Clock::time_point end) {
  auto* to = static_cast<char*>(data);
  while (bytes > 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
    if (left <= 0) return Received::late;
    pollfd wait{pipe, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) return Received::late;
    const auto got = ready < 0 ? -1 : ::read(pipe, to, bytes);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return Received::less;
    to += got;
    bytes -= static_cast<std::size_t>(got);
  }
  return Received::all;
}

struct Child {
  Received received = Received::less;
  RawMesh raw;
  std::string line;
};

void receive_answer(int pipe, Clock::time_point end, Child& child) {
  Answer answer;
  child.received = receive(pipe, &answer, sizeof answer, end);
  if (child.received != Received::all) return;
  if (answer.positions > max_words || answer.indices > max_words || answer.line > max_line) {
    child.received = Received::less;
    return;
  }
  child.raw.position.resize(answer.positions);
  child.raw.triangle.resize(answer.indices);
  child.line.resize(answer.line);
  const auto part = [&](void* data, std::size_t bytes) {
    if (child.received == Received::all) child.received = receive(pipe, data, bytes, end);
  };
  part(child.raw.position.data(), answer.positions * sizeof child.raw.position[0]);
  part(child.raw.triangle.data(), answer.indices * sizeof child.raw.triangle[0]);
  part(child.line.data(), answer.line);
}

/// Checks the mesh from the pipe, which is as untrusted as the file.
bool is_sound(const RawMesh& raw) {
  for (const auto& p : raw.position) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  for (const auto v : raw.triangle) {
    if (v >= raw.position.size()) return false;
  }
  return raw.triangle.size() % 3 == 0;
}

std::optional<Child> ask_child(const std::string& path) {
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return std::nullopt;
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  const pid_t process = ::fork();
  if (process == 0) {
    ::close(ends[0]);
    be_child(path, ends[1]);
  }
  ::close(ends[1]);
  std::optional<Child> child;
  if (process > 0) {
    child.emplace();
    receive_answer(ends[0], Clock::now() + wall_limit, *child);
    ::kill(process, SIGKILL);  // it has sent all, or will not
    while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(ends[0]);
  return child;
}

}  // namespace

Result<MeshFile> read_gltf(const std::string& path) {
  auto child = ask_child(path);
  if (!child) {
    return fail(
        fmt::format("{}: no process could be begun to read it; free some memory, or export it as .obj, .stl or "
                    ".ply",
                    path));
  }
  if (child->received == Received::late) {
    return fail(
        fmt::format("{}: not read within {} s; valid glTF takes less: export it again, or as .obj, .stl or .ply", path,
                    wall_limit.count()));
  }
  if (child->received == Received::less || !is_sound(child->raw)) {
    return fail(
        fmt::format("{}: what reads glTF broke down over it (limits: {} s, {} GB); the file may be damaged: "
                    "export it again, or as .obj, .stl or .ply",
                    path, processor_s, memory_bytes / 1'000'000'000));
  }
  if (!child->line.empty()) return fail(fmt::format("{}: {}", path, child->line));
  return join_mesh(child->raw, path);
}

}  // namespace mobil::inline v0_3

#else

namespace mobil::inline v0_3 {

Result<MeshFile> read_gltf(const std::string& path) {
  return fail(
      fmt::format("{}: glTF is not read on this system; valid: .obj, .stl, .ply: export it as one of them", path));
}

}  // namespace mobil::inline v0_3

#endif
