#pragma once
// Locations of measured data. Tables that can be redistributed are committed in assets/reference. Others, and
// anatomical meshes, are in folders outside the project; tests that need them are skipped if those are absent.

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace mobil::test {

/// Returns the folder named by the environment variable, or shared/`name` in the project's parent folder if it is
/// unset.
inline std::optional<std::filesystem::path> data_folder(const char* variable, const char* name) {
  const char* named = std::getenv(variable);
  const auto beside = std::filesystem::path(MOBIL_SOURCE_DIR).parent_path() / "shared" / name;
  const std::filesystem::path folder = named != nullptr ? std::filesystem::path(named) : beside;
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

/// Returns the folder of anatomical meshes.
inline std::optional<std::filesystem::path> anatomy_folder() {
  return data_folder("MOBIL_ANATOMY", "anatomy");
}

/// Returns a table of measured or published figures, the committed one if it exists.
inline std::optional<std::filesystem::path> reference_table(const std::string& file) {
  const auto committed = std::filesystem::path(MOBIL_SOURCE_DIR) / "assets/reference" / file;
  if (std::filesystem::exists(committed)) return committed;
  const auto folder = data_folder("MOBIL_REFERENCE", "reference");
  if (!folder || !std::filesystem::exists(*folder / file)) return std::nullopt;
  return *folder / file;
}

inline constexpr const char* no_table = "measured data that may not be committed: name their folder in MOBIL_REFERENCE";
inline constexpr const char* no_anatomy = "meshes that are not committed: name their folder in MOBIL_ANATOMY";

}  // namespace mobil::test
