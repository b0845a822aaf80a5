#pragma once
// Incomplete files and folders, and started programs, which an interrupted program must remove.

#include <sys/types.h>

#include <filesystem>
#include <mutex>

#include <mobil/assets/files/output_file.h>

namespace mobil::inline v0_3 {

/// Registers a file or folder as incomplete. Call it before making the path, and forget it once it is gone or has its
/// own name. `made` is the outermost folder above it that was made for it; the empty ones of those are removed with the
/// path. Safe from any thread. After `remove_unfinished` all callers block forever.
void note_unfinished(const std::filesystem::path& path, const std::filesystem::path& made = {});
void forget_unfinished(const std::filesystem::path& path);

/// Registers a program that was started and has not ended.
void note_started(pid_t process);
void forget_started(pid_t process);

/// Removes the path with its contents, and the empty folders above it up to `made`.
void remove_with_folders(const std::filesystem::path& path, const std::filesystem::path& made) noexcept;

/// Blocks removal while it is held, for steps that belong together. The holder can call the other functions.
std::unique_lock<std::recursive_mutex> hold_unfinished();

}  // namespace mobil::inline v0_3
