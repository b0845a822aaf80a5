#include <mobil/assets/files/output_file.h>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "assets/files/unfinished.h"

namespace mobil::inline v0_3 {
namespace {

namespace fs = std::filesystem;

constexpr int max_links = 40;  // as in the kernel
constexpr std::string_view advice = "choose a folder that exists, is writable and has space";

constexpr std::string_view hidden_start = ".mobil-", hidden_end = ".partial";

/// Short, so that it fits wherever the final name does; hidden, so that it is not taken for a result.
fs::path temporary_in(const fs::path& folder) {
  static std::atomic<unsigned> count{0};
  return folder / fmt::format("{}{}-{}{}", hidden_start, ::getpid(), count++, hidden_end);
}

fs::path folder_of_file(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Returns the target of the path's links, which need not exist. A path to a device or a pipe stays: links to those in
/// /proc are not paths.
Result<fs::path> followed(const fs::path& path, const std::string& shown) {
  fs::path at = path;
  std::error_code error;
  if (fs::is_other(fs::status(path, error))) return at;
  error.clear();
  for (int links = 0; fs::is_symlink(fs::symlink_status(at, error)); ++links) {
    if (links == max_links) return fail(fmt::format("{}: its links go round in a circle; name a file", shown));
    const fs::path next = fs::read_symlink(at, error);
    if (error) break;
    at = next.is_absolute() ? next : folder_of_file(at) / next;
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    return fail(fmt::format("{}: cannot be written ({}); {}", shown, error.message(), advice));
  }
  return at;
}

bool copied(const fs::path& from, const fs::path& to) {
  std::ifstream in(from, std::ios::binary);
  std::ofstream out(to, std::ios::binary | std::ios::trunc);
  std::vector<char> piece(std::size_t{1} << 20U);
  while (in.read(piece.data(), static_cast<std::streamsize>(piece.size())), in.gcount() > 0) {
    if (!out.write(piece.data(), in.gcount())) return false;
  }
  return in.eof() && out.flush().good();
}

/// Gives a new file the permissions, the owner and the group of the file that it will replace, as overwriting would. A
/// group that cannot be given gets no permissions.
void inherit_permissions(const fs::path& file, const fs::path& replaced) {
  struct stat was {};
  if (::stat(replaced.c_str(), &was) != 0) return;
  const bool same_group = ::chown(file.c_str(), was.st_uid, was.st_gid) == 0 ||
                          ::chown(file.c_str(), static_cast<uid_t>(-1), was.st_gid) == 0;
  ::chmod(file.c_str(), was.st_mode & (same_group ? 0777U : 0707U));
}

/// Moves a complete file to its place, following links and replacing an existing file.
Result<void> move_file(const fs::path& from, OutputFile& place) {
  std::error_code error;
  if (!place.in_place()) fs::rename(from, place.temporary(), error);  // fails if a link leads to another disk
  if ((place.in_place() || error) && !copied(from, place.temporary())) {
    return fail(fmt::format("{}: cannot be written ({}); {}", place.path().string(), std::strerror(errno), advice));
  }
  return place.put();
}

}  // namespace

Result<OutputFile> OutputFile::at(const fs::path& path) {
  const std::string shown = shown_path(path).string();
  auto target = followed(path, shown);
  if (!target) return tl::unexpected(target.error());
  std::error_code error;
  const fs::file_status there = fs::status(*target, error);
  if (fs::is_directory(there)) return fail(fmt::format("{}: a folder has that name; choose another", shown));
  const fs::path folder = folder_of_file(*target);
  if (!fs::is_directory(folder, error)) {
    return fail(fmt::format("{}: cannot be written, there is no folder {}; {}", shown, folder.string(), advice));
  }
  const bool replaces = fs::exists(there), in_place = replaces && !fs::is_regular_file(there);
  if ((!in_place && ::access(folder.c_str(), W_OK) != 0) || (replaces && ::access(target->c_str(), W_OK) != 0)) {
    return fail(fmt::format("{}: cannot be written ({}); {}", shown, std::strerror(errno), advice));
  }
  OutputFile file;
  file.path_ = shown;
  file.target_ = std::move(*target);
  file.temporary_ = in_place ? file.target_ : temporary_in(folder);
  file.open_ = !in_place;
  if (file.open_) note_unfinished(file.temporary_);
  return file;
}

Result<void> OutputFile::put() {
  if (!open_) return {};
  inherit_permissions(temporary_, target_);
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) {
    return fail(fmt::format("{}: cannot be put in place ({}); remove what is there or choose another name",
                            path_.string(), error.message()));
  }
  open_ = false;
  forget_unfinished(temporary_);
  return {};
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      open_(std::exchange(other.open_, false)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(target_, other.target_);
  std::swap(temporary_, other.temporary_);
  std::swap(open_, other.open_);
  return *this;
}

OutputFile::~OutputFile() {
  if (!open_) return;
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  forget_unfinished(temporary_);
}

fs::path shown_path(const fs::path& path) {
  fs::path shown;
  for (const fs::path& part : path) {
    const std::string& name = part.native();
    if (!name.starts_with(hidden_start) || !name.ends_with(hidden_end)) shown /= part;
  }
  return shown;
}

Result<void> write_file(const fs::path& path, std::string_view text) {
  auto file = OutputFile::at(path);
  if (!file) return tl::unexpected(file.error());
  {
    errno = 0;
    std::ofstream out(file->temporary(), std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    if (!out) {
      return fail(fmt::format("{}: cannot be written ({}); {}", file->path().string(),
                              errno != 0 ? std::strerror(errno) : "unknown reason", advice));
    }
  }
  return file->put();
}

Result<OutputFolder> OutputFolder::make(const fs::path& folder) {
  std::error_code error;
  OutputFolder made;
  made.path_ = folder;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error) && !error; at = at.parent_path()) {
    std::error_code nothing_there;
    if (fs::is_symlink(fs::symlink_status(at, nothing_there))) {
      return fail(fmt::format("{}: leads nowhere, because the link {} has no target; choose another with --out",
                              folder.string(), at.string()));
    }
    made.made_ = at;
    if (at == at.parent_path()) break;
  }
  made.inside_ = temporary_in(folder);
  const auto hold = hold_unfinished();  // after their removal no folder is made
  note_unfinished(made.inside_, made.made_);
  if (!error) fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    return fail(fmt::format("{}: cannot be made a folder ({}); choose another with --out", folder.string(),
                            error ? error.message() : "a file of that name is there"));
  }
  if (!fs::create_directory(made.inside_, error)) {
    return fail(fmt::format("{}: cannot be written to ({}); choose another folder with --out", folder.string(),
                            error ? error.message() : "a name is taken"));
  }
  return made;
}

namespace {

/// Returns the ending of a name after its number: .png of frame_0012.png; nothing for a name of another form.
std::optional<std::string> after_number(const std::string& name, std::string_view before) {
  if (before.empty() || !name.starts_with(before)) return std::nullopt;
  const auto first = name.begin() + static_cast<std::ptrdiff_t>(before.size());
  const auto end = std::find_if_not(first, name.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (end == first) return std::nullopt;
  return std::string(end, name.end());
}

}  // namespace

Result<void> OutputFolder::put(std::string_view numbered) {
  std::error_code error;
  std::vector<std::pair<fs::path, OutputFile>> moves;
  std::set<std::string> names, endings;
  for (const auto& entry : fs::directory_iterator(inside_, error)) {
    const std::string name = entry.path().filename().string();
    names.insert(name);
    if (const auto ending = after_number(name, numbered)) endings.insert(*ending);
    auto place = OutputFile::at(path_ / entry.path().filename());
    if (!place) return tl::unexpected(place.error());
    moves.emplace_back(entry.path(), std::move(*place));
  }
  if (error) return fail(fmt::format("{}: cannot be read again ({})", inside_.string(), error.message()));
  const auto hold = hold_unfinished();
  for (auto& [from, place] : moves) {
    if (auto moved = move_file(from, place); !moved) return moved;
  }
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(path_, error)) {
    const std::string name = entry.path().filename().string();
    const auto ending = after_number(name, numbered);
    if (ending && endings.contains(*ending) && !names.contains(name) && entry.is_regular_file(error))
      old.push_back(entry.path());
  }
  for (const fs::path& file : old) fs::remove(file, error);
  remove_with_folders(inside_, {});
  forget_unfinished(inside_);
  inside_.clear();
  return {};
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)), inside_(std::exchange(other.inside_, {})), made_(std::exchange(other.made_, {})) {}

OutputFolder& OutputFolder::operator=(OutputFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(inside_, other.inside_);
  std::swap(made_, other.made_);
  return *this;
}

OutputFolder::~OutputFolder() {
  if (inside_.empty()) return;
  remove_with_folders(inside_, made_);
  forget_unfinished(inside_);
}

}  // namespace mobil::inline v0_3
