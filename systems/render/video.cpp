#include <mobil/video.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <mobil/assets/files/output_file.h>
#include "assets/files/unfinished.h"

extern char** environ;

namespace mobil::inline v0_3 {
namespace {

/// A file descriptor that closes itself. In a host that has closed standard descriptors the system gives their numbers
/// to new ones. Those are replaced, because ffmpeg's standard descriptors are set one after the other.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {
    if (fd < 0 || fd > STDERR_FILENO) return;
    fd_ = ::fcntl(fd, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    ::close(fd);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor() { reset(); }
  int get() const { return fd_; }
  void reset() {
    if (fd_ >= 0) ::close(std::exchange(fd_, -1));
  }

 private:
  int fd_;
};

// clang-format off: an option and its value stay together.
std::vector<std::string> ffmpeg_arguments(const std::string& to, int width, int height, double rate) {
  return {"ffmpeg",
          "-nostdin",
          "-hide_banner",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgba",
          "-s",
          fmt::format("{}x{}", width, height),
          "-r",
          fmt::format("{}", rate),
          "-i",
          "pipe:0",
          "-an",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-c:v",
          "libx264",
          "-preset",
          "veryfast",
          "-crf",
          "20",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          "file:" + to};
}
// clang-format on

/// Starts ffmpeg from the PATH, without a shell and with default signal handling, independent of the host's. Returns 0
/// or an errno.
int start(const std::vector<std::string>& arguments, int input, int log, pid_t& process) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, log, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error = posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == 0) note_started(process);
  return error;
}

}  // namespace

struct VideoWriter::Encoder {
  std::string path;
  std::optional<OutputFile> place;
  int width = 0, height = 0, pictures = 0;
  Descriptor pictures_in, log;
  pid_t process = 0;
  int signal = 0;  // that ended ffmpeg

  ~Encoder() {
    if (process <= 0) return;
    kill(process, SIGKILL);
    finish();
  }

  /// Ends the stream and waits for ffmpeg. Returns true if it succeeded.
  bool finish() {
    pictures_in.reset();
    int status = 0;
    pid_t ended = 0;
    do ended = waitpid(process, &status, 0);
    while (ended < 0 && errno == EINTR);
    forget_started(process);
    if (ended == process && WIFSIGNALED(status)) signal = WTERMSIG(status);
    const bool content = ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    process = 0;
    return content;
  }

  /// Removes the unfinished file after a failure and returns the first line of ffmpeg's message.
  tl::unexpected<Error> give_up() {
    if (process > 0) finish();
    place.reset();
    std::array<char, 400> text{};
    const ssize_t size = pread(log.get(), text.data(), text.size(), 0);
    std::string said(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    said = said.substr(0, said.find('\n'));
    return fail(
        fmt::format("{}: ffmpeg could not write this film ({}); name a file in a folder that exists, is writable "
                    "and has room",
                    path, !said.empty() ? said : signal != 0 ? strsignal(signal) : "it stopped without a word"));
  }
};

VideoWriter::VideoWriter(std::unique_ptr<Encoder> encoder) : encoder_(std::move(encoder)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::create(const std::string& path, int width, int height, double pictures_per_second) {
  const std::string ending = path.size() > 4 ? path.substr(path.size() - 4) : std::string();
  if (ending != ".mp4" && ending != ".MP4") {
    return fail(fmt::format("{}: a film's name must end in .mp4", path));
  }
  if (width < 2 || height < 2 || width > 8192 || height > 8192 || width % 2 != 0 || height % 2 != 0) {
    return fail(
        fmt::format("{}: a film of {} x {} pixels was asked for; each side must be an even number within 2-8192", path,
                    width, height));
  }
  if (!(pictures_per_second >= 1 && pictures_per_second <= 240)) {
    return fail(fmt::format("{}: a film of {} pictures a second was asked for; it must be within 1-240", path,
                            pictures_per_second));
  }
  auto place = OutputFile::at(path);
  if (!place) return tl::unexpected(place.error());
  auto encoder = std::make_unique<Encoder>();
  encoder->path = shown_path(path).string();
  encoder->place = std::move(*place);
  encoder->width = width;
  encoder->height = height;
  encoder->log = Descriptor(memfd_create("ffmpeg errors", MFD_CLOEXEC));
  // A socket instead of a pipe, because writing after the reader has died gives an error instead of a signal.
  std::array<int, 2> ends{-1, -1};
  if (encoder->log.get() < 0 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return fail(
        fmt::format("{}: cannot talk to ffmpeg ({}); close other files or programs", path, std::strerror(errno)));
  }
  encoder->pictures_in = Descriptor(ends[0]);
  const Descriptor ffmpeg_reads(ends[1]);
  const int error = start(ffmpeg_arguments(encoder->place->temporary().string(), width, height, pictures_per_second),
                          ffmpeg_reads.get(), encoder->log.get(), encoder->process);
  if (error != 0) {
    encoder->process = 0;
    if (error == ENOENT) {
      return fail(
          fmt::format("{}: films need the ffmpeg program, which is not on the PATH; apt-get install ffmpeg", path));
    }
    return fail(fmt::format("{}: cannot start ffmpeg ({}); check that it runs", path, std::strerror(error)));
  }
  return VideoWriter(std::move(encoder));
}

Result<void> VideoWriter::add(const Image& image) {
  Encoder& e = *encoder_;
  if (e.process <= 0) return fail(fmt::format("{}: this film is closed; begin another", e.path));
  if (image.width != e.width || image.height != e.height ||
      image.rgba.size() != 4 * static_cast<std::size_t>(e.width) * static_cast<std::size_t>(e.height)) {
    return fail(fmt::format("{}: a picture of {} x {} pixels does not fit this film of {} x {}", e.path, image.width,
                            image.height, e.width, e.height));
  }
  for (std::size_t sent = 0; sent < image.rgba.size();) {
    const ssize_t n = send(e.pictures_in.get(), image.rgba.data() + sent, image.rgba.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return e.give_up();
    sent += static_cast<std::size_t>(n);
  }
  ++e.pictures;
  return {};
}

Result<void> VideoWriter::close() {
  Encoder& e = *encoder_;
  if (e.process <= 0) return fail(fmt::format("{}: this film is closed; begin another", e.path));
  if (!e.finish()) return e.give_up();
  const bool empty = e.pictures == 0;
  auto done = empty ? fail(fmt::format("{}: a film needs at least one picture", e.path)) : e.place->put();
  e.place.reset();
  return done;
}

}  // namespace mobil::inline v0_3
