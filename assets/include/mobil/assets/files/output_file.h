#pragma once
// Output files that appear under their final name only when complete, one by one or all of one run together.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// A file written under a temporary name until it is complete. Symbolic links are followed. A path that is not a
/// regular file (device, pipe) is written directly and never replaced. Dropped before `put`, it leaves nothing behind.
class OutputFile {
 public:
  /// Fails if the path is a folder, its folder is missing or not writable, or its links form a cycle.
  static Result<OutputFile> at(const std::filesystem::path& path);

  /// Returns the path to open for writing: a new name in the same folder, or the device itself.
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& path() const { return path_; }

  /// True if that is the device itself.
  bool in_place() const { return temporary_ == target_; }

  /// Renames the file to its path, over an existing file. Fails if the folder is not writable or a folder has the name.
  Result<void> put();

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

 private:
  OutputFile() = default;
  std::filesystem::path path_, target_, temporary_;  // target: path with its links followed
  bool open_ = false;                                // not put yet: the destructor removes the temporary file
};

/// Returns a path as messages name it: without the hidden folder of results that are not complete.
std::filesystem::path shown_path(const std::filesystem::path& path);

/// Writes the text through an OutputFile. Fails as that does, if not writable or if the disk is full; nothing is left.
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

/// Results of one run, which appear in their folder together. Until `put` they are in a hidden folder inside it.
/// Dropped before `put`, it leaves nothing behind, including the folder if it was made for them.
class OutputFolder {
 public:
  /// Makes the folder with its parents. Fails if it cannot be made or written to.
  static Result<OutputFolder> make(const std::filesystem::path& folder);

  /// Returns the folder for results. `put` moves all files in it; it must not contain folders.
  const std::filesystem::path& inside() const { return inside_; }
  const std::filesystem::path& path() const { return path_; }

  /// Moves all files to their place, over files of their names; links and devices as OutputFile. If some are called
  /// `numbered`, a number and an ending (frame_0012.png), removes such files of an earlier run that are not among them.
  /// Fails if a folder has one of the names, and then moves none, or if the disk fails half way.
  Result<void> put(std::string_view numbered = {});

  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&& other) noexcept;
  ~OutputFolder();

 private:
  OutputFolder() = default;
  std::filesystem::path path_, inside_;
  std::filesystem::path made_;  // outermost folder that did not exist before; empty if all did
};

/// For an interrupted program: removes incomplete files, pictures and videos and kills the programs that write them.
/// Call it last and on its own thread, not in a signal handler, because it allocates. Later writers block forever.
void remove_unfinished() noexcept;

}  // namespace mobil::inline v0_3
