#pragma once
// What a program that is interrupted must take away with it: files and folders that are not complete yet, and programs
// that it has started.

#include <sys/types.h>

#include <filesystem>
#include <mutex>

#include <mobil/assets/files/output_file.h>

namespace mobil::inline v0_3 {

/// From here on the path is a file or folder that is not complete. Noted before it is made, forgotten once it is gone
/// or has its own name. `made`: the outermost of the folders above it that were made for it; with the path, those go
/// that are empty. Any thread may call; after `remove_unfinished` all callers wait for ever.
void note_unfinished(const std::filesystem::path& path, const std::filesystem::path& made = {});
void forget_unfinished(const std::filesystem::path& path);

/// The same of a program that was started and has not ended.
void note_started(pid_t process);
void forget_started(pid_t process);

/// Removes the path, whatever is in it, and the folders above it up to `made` as far as they are empty.
void remove_with_folders(const std::filesystem::path& path, const std::filesystem::path& made) noexcept;

/// While it is held nothing is taken away: for steps that must all be done or none. The holder may call the others.
std::unique_lock<std::recursive_mutex> hold_unfinished();

}  // namespace mobil::inline v0_3
