#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <utility>

#include <mobil/assets/files/output_file.h>
#include <mobil/snapshot_file.h>

namespace mobil::inline v0_3 {
namespace {

/// Descriptor of an open file or folder, closed on destruction.
class Handle {
 public:
  Handle(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  bool open() const { return number_ >= 0; }
  int number() const { return number_; }
  bool close() {
    const int number = std::exchange(number_, -1);
    return number < 0 || ::close(number) == 0;
  }

 private:
  int number_;
};

bool write_all(const Handle& file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

tl::unexpected<Error> refused(const std::filesystem::path& path, const char* what, const char* mend) {
  return fail(fmt::format("{}: cannot be {} ({}); {}", path.string(), what, std::strerror(errno), mend));
}

}  // namespace

Result<void> save_file(const Simulation& simulation, const std::filesystem::path& path) {
  const std::size_t size = simulation.snapshot_bytes();
  const auto bytes = std::make_unique_for_overwrite<std::byte[]>(size);
  const auto saved = simulation.save({bytes.get(), size});
  if (!saved) return tl::unexpected(saved.error());

  auto place = OutputFile::at(path);
  if (!place) return tl::unexpected(place.error());
  Handle file(place->temporary(), O_WRONLY | O_CREAT | O_TRUNC);
  const bool written = file.open() && write_all(file, {bytes.get(), *saved}) &&
                       (place->in_place() || ::fsync(file.number()) == 0) && file.close();
  if (!written) return refused(path, "written", "choose a folder that exists, is writable and has space");
  if (auto put = place->put(); !put) return put;
  if (place->in_place()) return {};
  const Handle folder(place->temporary().parent_path(), O_RDONLY | O_DIRECTORY);
  if (!folder.open() || ::fsync(folder.number()) != 0)
    return refused(path, "made safe on the disk", "the file is there, but may not outlive a loss of power");
  return {};
}

Result<void> restore_file(Simulation& simulation, const std::filesystem::path& path, const RestoreLimits& limits) {
  const Handle file(path, O_RDONLY);
  struct stat about {};
  if (!file.open() || ::fstat(file.number(), &about) != 0)
    return refused(path, "read", "give a file that `save_file` wrote");
  if (!S_ISREG(about.st_mode))
    return fail(fmt::format("{}: is no plain file; give one that `save_file` wrote", path.string()));
  const auto size = static_cast<std::size_t>(about.st_size);
  std::unique_ptr<std::byte[]> bytes(new (std::nothrow) std::byte[size]);
  if (bytes == nullptr)
    return fail(
        fmt::format("{}: there is no memory for its {} bytes; give a file that `save_file` wrote", path.string(), size),
        Status::no_memory);
  for (std::size_t at = 0; at < size;) {
    const ssize_t got = ::read(file.number(), bytes.get() + at, size - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return refused(path, "read", "give a file that `save_file` wrote");
    if (got == 0) return fail(fmt::format("{}: became shorter while it was read; try again", path.string()));
    at += static_cast<std::size_t>(got);
  }
  if (auto done = simulation.restore({bytes.get(), size}, limits); !done)
    return fail(fmt::format("{}: {}", path.string(), done.error().message), done.error().status);
  return {};
}

Result<void> Rollback::keep(const Simulation& simulation) {
  if (kept_.empty()) return {};
  Kept& kept = kept_[next_];
  const std::size_t size = simulation.snapshot_bytes();
  if (kept.bytes.size() < size) kept.bytes.resize(size + size / 8);
  const auto saved = simulation.save(kept.bytes);
  if (!saved) return tl::unexpected(saved.error());
  kept.used = *saved;
  next_ = (next_ + 1) % kept_.size();
  depth_ = std::min(depth_ + 1, kept_.size());
  return {};
}

Result<void> Rollback::back(Simulation& simulation, std::size_t times) {
  if (times == 0 || times > depth_)
    return fail(fmt::format("back: {} times is out of range; choose 1 to the {} that are kept", times, depth_));
  const std::size_t at = (next_ + kept_.size() - times) % kept_.size();
  if (auto done = simulation.restore(std::span(kept_[at].bytes).first(kept_[at].used), RestoreLimits::none()); !done)
    return done;
  next_ = at;
  depth_ -= times;
  return {};
}

}  // namespace mobil::inline v0_3
