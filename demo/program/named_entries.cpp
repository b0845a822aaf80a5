#include "demo/program/named_entries.h"

#include <unistd.h>

#include <filesystem>

namespace mobil {

Result<void> check_json_place(const std::string& text) {
  if (text.empty()) return fail("--json is empty; give it a file's name");
  const std::filesystem::path path = text;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return fail(fmt::format("--json {}: a folder has that name", text));
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!std::filesystem::is_directory(folder, ignored) || access(folder.c_str(), W_OK) != 0) {
    return fail(fmt::format("--json {}: cannot be written; choose a folder that exists and is writable", text));
  }
  return {};
}

}  // namespace mobil
