#include "assets/files/output_file.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

namespace mobil {

Result<void> write_file(const std::filesystem::path& path, std::string_view text) {
  auto temporary = path;
  temporary += ".partial";
  std::error_code ignored;
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    if (!out) {
      std::filesystem::remove(temporary, ignored);
      return fail(
          fmt::format("{}: cannot be written; choose a folder that exists, is writable and has space", path.string()));
    }
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) {
    std::filesystem::remove(temporary, ignored);
    return fail(fmt::format("{}: cannot be put in place ({}); remove what is there or choose another name",
                            path.string(), error.message()));
  }
  return {};
}

Result<void> make_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    return fail(fmt::format("{}: cannot be made a folder ({}); choose another with --out", folder.string(),
                            error ? error.message() : "a file of that name is there"));
  }
  const auto probe = folder / ".mobil-probe";
  if (!write_file(probe, "")) {
    return fail(fmt::format("{}: cannot be written to; choose another folder with --out", folder.string()));
  }
  std::filesystem::remove(probe, error);
  return {};
}

}  // namespace mobil
