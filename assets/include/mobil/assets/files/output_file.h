#pragma once
// Results on disk: complete under their final name, or not there at all; and those of one run together.

#include <filesystem>
#include <string_view>

#include <mobil/engine/error.h>

namespace mobil::inline v0_3 {

/// Where one result is written until it is complete. Symbolic links are followed. What is no regular file (a device, a
/// pipe) is written to itself and never replaced. Dropped before `put`, it leaves nothing behind.
class OutputFile {
 public:
  /// Error: the path is a folder, its folder is missing or not writable, or its links go round in a circle.
  static Result<OutputFile> at(const std::filesystem::path& path);

  /// Open this for writing: a new name in the same folder, or the device itself.
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& path() const { return path_; }

  /// Whether that is the device itself.
  bool in_place() const { return temporary_ == target_; }

  /// Gives the file its name, over what was there. Error: the folder is not writable, or a folder has taken the name.
  Result<void> put();

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  ~OutputFile();

 private:
  OutputFile() = default;
  std::filesystem::path path_, target_, temporary_;  // target: path with its links followed
  bool open_ = false;                                // not put yet: the temporary file is ours to remove
};

/// Writes the text by an OutputFile. Errors: those, not writable, disk full; nothing is left behind.
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

/// The results of one run, which appear in their folder together: until `put` they lie in a hidden folder inside it.
/// Dropped before, nothing is left behind, nor the folder where it was made for them.
class OutputFolder {
 public:
  /// Makes the folder with its parents. Error: it cannot be made, or nothing can be written in it.
  static Result<OutputFolder> make(const std::filesystem::path& folder);

  /// Where to write results: all files in it are moved by `put`. No folders in it.
  const std::filesystem::path& inside() const { return inside_; }
  const std::filesystem::path& path() const { return path_; }

  /// Moves all files to their place, over files of their names; links and devices as OutputFile. Where there are some
  /// called `numbered`, a number and an ending (frame_0012.png), those of an earlier run that are not among them go.
  /// Error: a folder has one of the names, and then none is moved; or the disk fails half way.
  Result<void> put(std::string_view numbered = {});

  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&& other) noexcept;
  ~OutputFolder();

 private:
  OutputFolder() = default;
  std::filesystem::path path_, inside_;
  std::filesystem::path made_;  // the outermost folder that was not there before; empty where all were
};

/// For a program that is interrupted: removes what is not complete, here and of pictures and videos, and kills the
/// programs that write them. The last thing that it does, on a thread of its own: not in a signal handler, for it
/// allocates. Whoever writes after that waits for ever.
void remove_unfinished() noexcept;

}  // namespace mobil::inline v0_3
