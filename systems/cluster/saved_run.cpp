#include <mobil/systems/cluster/saved_run.h>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include <mobil/systems/cluster/message.h>

namespace mobil::inline v0_3 {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept = 2;  // snapshots
constexpr std::string_view prefix = "tick_";

fs::path snapshot_folder(const fs::path& folder, std::uint32_t tick) {
  return folder / fmt::format("{}{:010}", prefix, tick);
}

fs::path shard_file(const fs::path& folder, std::uint32_t tick, std::uint32_t shard) {
  return snapshot_folder(folder, tick) / fmt::format("shard_{:04}", shard);
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<std::vector<std::byte>> read_bytes(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error))
    return fail(fmt::format("{}: cannot be read, there is no such file", path.string()));
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  const auto size = in ? static_cast<std::streamoff>(in.tellg()) : -1;
  if (size < 0) return fail(fmt::format("{}: cannot be read ({})", path.string(), std::strerror(errno)));
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), size))
    return fail(fmt::format("{}: cannot be read to its end", path.string()));
  return bytes;
}

/// Returns the ticks of the snapshots in a folder, complete or not, the last first.
std::vector<std::uint32_t> snapshot_ticks(const fs::path& folder) {
  std::vector<std::uint32_t> ticks;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    std::uint32_t tick = 0;
    const char *first = name.data() + prefix.size(), *last = name.data() + name.size();
    if (const auto read = std::from_chars(first, last, tick); read.ec == std::errc() && read.ptr == last)
      ticks.push_back(tick);
  }
  std::ranges::sort(ticks, std::greater());
  return ticks;
}

/// Writes a file under a temporary name and renames it, so that it is complete or missing. Each file has one writer, so
/// the temporary name needs no process id, which can be the same on other machines.
Result<void> write_whole(const fs::path& path, std::span<const std::byte> bytes) {
  fs::path meanwhile = path;
  meanwhile += ".new";
  errno = 0;
  std::ofstream out(meanwhile, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  out.close();
  std::error_code error(errno, std::generic_category());
  if (out) fs::rename(meanwhile, path, error);
  if (out && !error) return {};
  const std::string reason = error ? error.message() : "unknown reason";
  fs::remove(meanwhile, error);
  return fail(
      fmt::format("{}: cannot be written ({}); choose a folder that is writable and has space", path.string(), reason));
}

/// Removes the files of a snapshot, and its folder if that is then empty.
void remove_snapshot(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> ours;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("shard_") || name.starts_with("index") || name.starts_with("commands"))
      ours.push_back(entry.path());
  }
  for (const fs::path& file : ours) fs::remove(file, error);
  fs::remove(folder, error);
}

Result<void> make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error) return {};
  return fail(
      fmt::format("{}: cannot be made ({}); choose a folder that can be written", folder.string(), error.message()));
}

struct IndexHead {
  std::uint32_t tick, shards;
  std::uint64_t state_hash, about, host;
};

}  // namespace

std::vector<std::byte> pack(const SavedRun& run) {
  const IndexHead head{run.tick, run.shards, run.state_hash, run.about.size(), run.host.size()};
  std::vector<std::byte> bytes;
  for (const auto part :
       {std::as_bytes(std::span(&head, 1)), std::as_bytes(std::span(run.about)), std::span<const std::byte>(run.host)})
    bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

Result<SavedRun> unpack_run(std::span<const std::byte> bytes) {
  IndexHead head{};
  if (bytes.size() < sizeof head) return fail("the index of a snapshot was cut");
  std::memcpy(&head, bytes.data(), sizeof head);
  const auto behind = bytes.subspan(sizeof head);
  if (head.about > behind.size() || head.host != behind.size() - head.about)
    return fail("the index of a snapshot does not agree with itself");
  const auto about = behind.first(static_cast<std::size_t>(head.about)), host = behind.subspan(about.size());
  return SavedRun{head.tick, head.shards, head.state_hash, std::string(text_of(about)), {host.begin(), host.end()}};
}

Result<void> write_shard(const fs::path& folder, std::uint32_t tick, std::uint32_t shard,
                         std::span<const std::byte> bytes) {
  if (auto made = make_folder(snapshot_folder(folder, tick)); !made) return made;
  std::vector<std::byte> named(sizeof shard + bytes.size());
  std::memcpy(named.data(), &shard, sizeof shard);
  std::ranges::copy(bytes, named.begin() + sizeof shard);
  return write_whole(shard_file(folder, tick, shard), seal_message({MessageKind::shard, tick, named}));
}

Result<std::vector<std::byte>> read_shard(const fs::path& folder, std::uint32_t tick, std::uint32_t shard) {
  const fs::path path = shard_file(folder, tick, shard);
  auto sealed = read_bytes(path);
  if (!sealed) return sealed;
  const auto message = open_message(*sealed, MessageKind::shard);
  if (!message) return fail(fmt::format("{}: {}", path.string(), message.error().message));
  std::uint32_t named = 0;
  if (message->bytes.size() >= sizeof named) std::memcpy(&named, message->bytes.data(), sizeof named);
  if (message->bytes.size() < sizeof named || named != shard || message->tick != tick)
    return fail(fmt::format("{}: is of another shard or tick", path.string()));
  return std::vector(message->bytes.begin() + sizeof named, message->bytes.end());
}

Result<void> write_index(const fs::path& folder, const SavedRun& run) {
  const auto sealed = seal_message({MessageKind::index, run.tick, pack(run)});
  if (auto done = write_whole(snapshot_folder(folder, run.tick) / "index", sealed); !done) return done;
  std::size_t whole = 0;
  for (const std::uint32_t tick : snapshot_ticks(folder)) {
    std::error_code error;
    if (tick <= run.tick && fs::exists(snapshot_folder(folder, tick) / "index", error) && ++whole <= kept) continue;
    remove_snapshot(snapshot_folder(folder, tick));
  }
  return {};
}

Result<std::vector<SavedRun>> whole_snapshots(const fs::path& folder) {
  std::vector<SavedRun> whole;
  std::string why = "no snapshot is there";
  for (const std::uint32_t tick : snapshot_ticks(folder)) {
    const fs::path path = snapshot_folder(folder, tick) / "index";
    const auto sealed = read_bytes(path);
    if (!sealed) continue;  // incomplete record
    const auto message = open_message(*sealed, MessageKind::index);
    auto run = message ? unpack_run(message->bytes) : tl::unexpected(message.error());
    if (run && run->tick == tick)
      whole.push_back(std::move(*run));
    else
      why = fmt::format("{}: {}", path.string(), run ? "is of another tick" : run.error().message);
  }
  if (!whole.empty()) return whole;
  return fail(fmt::format("{}: {}; name the folder that a run with --save wrote", folder.string(), why));
}

bool holds_a_run(const fs::path& folder) {
  return !snapshot_ticks(folder).empty();
}

Result<FolderLock> FolderLock::take(const fs::path& folder) {
  if (auto made = make_folder(folder); !made) return tl::unexpected(made.error());
  const int file = ::open((folder / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (file < 0) return fail(fmt::format("{}: cannot be written ({})", folder.string(), std::strerror(errno)));
  if (::flock(file, LOCK_EX | LOCK_NB) == 0) return FolderLock(file);
  ::close(file);
  return fail(fmt::format("{}: another run is writing there; end it, or name another folder", folder.string()));
}

FolderLock::FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(file_, other.file_);
  return *this;
}
FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

Result<CommandLog> CommandLog::begin(const fs::path& folder, std::uint32_t tick,
                                     std::span<const LoggedCommands> first) {
  CommandLog log;
  log.path_ = snapshot_folder(folder, tick) / "commands";
  log.file_.reset(std::fopen(log.path_.c_str(), "wbe"));
  if (log.file_ == nullptr)
    return fail(fmt::format("{}: cannot be written ({})", log.path_.string(), std::strerror(errno)));
  for (const LoggedCommands& one : first)
    if (auto done = log.add(one.tick, one.commands); !done) return tl::unexpected(done.error());
  return log;
}

Result<CommandLog> CommandLog::resume(const fs::path& folder, std::uint32_t tick, std::vector<LoggedCommands>& logged) {
  logged.clear();
  CommandLog log;
  auto ticks = snapshot_ticks(folder);
  std::ranges::reverse(ticks);
  std::error_code error;
  for (const std::uint32_t from : ticks) {
    const fs::path path = snapshot_folder(folder, from) / "commands";
    if (from < tick || !fs::exists(snapshot_folder(folder, from) / "index", error) || !fs::exists(path, error))
      continue;
    const auto bytes = read_bytes(path);
    if (!bytes) return tl::unexpected(bytes.error());
    std::span<const std::byte> left = *bytes;
    while (!left.empty()) {
      const std::size_t at = bytes->size() - left.size();
      const auto message = take_message(left);
      if (!message && message.error().status == Status::missing) break;  // incomplete record
      const auto next = tick + static_cast<std::uint32_t>(logged.size());
      if (!message || message->kind != MessageKind::commands || message->tick > next)
        return fail(
            fmt::format("{}: the record at byte {} was altered, or ticks are missing before it; `truncate -s {}` "
                        "goes on without it and what follows",
                        path.string(), at, at));
      if (message->tick == next) logged.push_back({message->tick, {message->bytes.begin(), message->bytes.end()}});
    }
    fs::resize_file(path, bytes->size() - left.size(), error);
    log.path_ = path;
  }
  if (log.path_.empty()) return begin(folder, tick, {});
  log.file_.reset(std::fopen(log.path_.c_str(), "abe"));
  if (log.file_ == nullptr) return fail(fmt::format("{}: cannot be written", log.path_.string()));
  return log;
}

Result<void> CommandLog::add(std::uint32_t tick, std::span<const std::byte> commands) {
  const auto sealed = seal_message({MessageKind::commands, tick, commands});
  const bool written = std::fwrite(sealed.data(), 1, sealed.size(), file_.get()) == sealed.size();
  if (written && std::fflush(file_.get()) == 0) return {};
  return fail(fmt::format("{}: cannot be written ({}); make room on the disk, then --resume", path_.string(),
                          std::strerror(errno)));
}

}  // namespace mobil::inline v0_3
