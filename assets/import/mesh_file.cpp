#include <mobil/mesh_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include "assets/import/mesh_gltf.h"
#include "assets/import/mesh_obj.h"
#include "assets/import/mesh_ply.h"
#include "assets/import/mesh_stl.h"
#include "assets/import/mesh_text.h"

namespace mobil::inline v0_3 {
namespace {

enum class MeshFormat : std::uint8_t { obj, stl, ply, gltf };

/// Returns the format by the ending of the name, in any case.
Result<MeshFormat> format_of(const std::string& path) {
  const std::string end = std::filesystem::path(path).extension().string();
  if (same_word(end, ".obj")) return MeshFormat::obj;
  if (same_word(end, ".stl")) return MeshFormat::stl;
  if (same_word(end, ".ply")) return MeshFormat::ply;
  if (same_word(end, ".gltf") || same_word(end, ".glb")) return MeshFormat::gltf;
  return fail(
      fmt::format("{}: {} is not a format that is read; valid: .obj, .stl, .ply, .gltf, .glb: export the mesh as "
                  "one of these",
                  path, shown(end)));
}

tl::unexpected<Error> too_large(const std::string& path, std::uintmax_t bytes) {
  return fail(fmt::format("{}: {:.0f} MB; valid: at most {} MB: make the mesh coarser in a mesh editor", path,
                          static_cast<double>(bytes) / 1e6, max_mesh_bytes / 1'000'000));
}

Result<MeshFile> read_bytes(std::string_view bytes, const std::string& path, MeshFormat format,
                            const std::filesystem::path& folder) {
  if (bytes.size() > max_mesh_bytes) return too_large(path, bytes.size());
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    return fail(fmt::format("{}: text in UTF-16; save it as UTF-8, or export the mesh again", path));
  }
  if (format == MeshFormat::obj) return read_obj(bytes, path);
  if (format == MeshFormat::stl) return read_stl(bytes, path);
  if (format == MeshFormat::ply) return read_ply(bytes, path);
  return read_gltf(bytes, path, folder);
}

}  // namespace

Result<MeshFile> read_mesh_bytes(std::string_view bytes, const std::string& path) {
  const auto format = format_of(path);
  if (!format) return tl::unexpected(format.error());
  return read_bytes(bytes, path, *format, {});
}

Result<MeshFile> read_mesh(const std::string& path) try {
  const auto format = format_of(path);
  if (!format) return tl::unexpected(format.error());
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return fail(fmt::format("{}: no such file; put the mesh there or take its row out of the manifest", path));
  }
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > max_mesh_bytes) return too_large(path, size);
  std::string bytes(error ? 0 : static_cast<std::size_t>(size), '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) return fail(fmt::format("{}: cannot be read; make it readable, or copy it again", path));
  return read_bytes(bytes, path, *format, std::filesystem::canonical(path).parent_path());
} catch (const std::exception& error) {
  return fail(
      fmt::format("{}: cannot be read ({}); free some memory, or make the mesh coarser", path, shown(error.what())));
}

}  // namespace mobil::inline v0_3
