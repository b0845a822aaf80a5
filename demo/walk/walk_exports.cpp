#include "demo/walk/walk_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>

#include <mobil/bvh_writer.h>
#include <mobil/gl_writer.h>
#include <mobil/gltf_writer.h>
#include <mobil/opensim_writer.h>
#include <mobil/usd_writer.h>
#include <mobil/x3d_writer.h>

namespace mobil {
namespace {

/// In the order of WalkFormat.
constexpr std::string_view endings[] = {".glb", ".bvh", ".mot", ".sto", ".usda", ".wrl", ".x3d", ".gl"};

}  // namespace

const char* const walk_exports_help =
    "Formats of --export, by the file's ending (lengths in m, +Y up, walking toward +Z; assets/export/README.md has "
    "more):\n"
    "  .glb   glTF, as walk.glb: a skin over 48 joints, bones, muscles as morph targets; for engines, Blender, "
    "browsers\n"
    "  .usda  USD: skeleton, skinned bones, muscles as point caches; for Houdini, Omniverse, Blender, Maya\n"
    "  .bvh   skeleton and joint angles of every tick; for programs that animate characters\n"
    "  .mot   OpenSim's coordinates of its gait2392 model, every tick, in its axes; .sto: forces of the ground\n"
    "  .x3d   X3D, and .wrl VRML97: geometry with interpolators for joints and muscles\n"
    "  .gl    vertices, normals and triangles for OpenGL, a block a picture\n";

Result<std::vector<WalkExport>> read_exports(const std::vector<std::string>& names) {
  std::vector<WalkExport> wanted;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    const std::filesystem::path path(name);
    if (path.filename() != path) {
      return fail(fmt::format("--export {}: is written into the folder of --out; give a name without folders", name));
    }
    const auto* const ending = std::ranges::find(endings, path.extension().string());
    if (ending == std::end(endings)) {
      std::string known;
      for (const auto& one : endings) known += fmt::format("{}{}", known.empty() ? "" : ", ", one);
      return fail(fmt::format("--export {}: ends in no known format; there are {}", name, known));
    }
    if (!taken.insert(name).second) return fail(fmt::format("--export {}: is given twice; leave one out", name));
    wanted.push_back({name, static_cast<WalkFormat>(ending - std::begin(endings))});
  }
  return wanted;
}

bool of_every_tick(const WalkExport& wanted) {
  return wanted.format == WalkFormat::bvh || wanted.format == WalkFormat::mot || wanted.format == WalkFormat::sto;
}

Result<void> write_export(const WalkExport& wanted, const WalkRecording& pictures, const WalkRecording& ticks,
                          const std::filesystem::path& folder) {
  const auto file = folder / wanted.file;
  switch (wanted.format) {
    case WalkFormat::glb: {
      const auto written = write_glb(file, pictures);
      return written ? Result<void>{} : tl::unexpected(written.error());
    }
    case WalkFormat::bvh:
      return write_bvh(file, ticks);
    case WalkFormat::mot:
      return write_opensim_motion(file, ticks);
    case WalkFormat::sto:
      return write_opensim_forces(file, ticks);
    case WalkFormat::usda:
      return write_usda(file, pictures);
    case WalkFormat::wrl:
      return write_x3d(file, pictures, SceneNotation::vrml);
    case WalkFormat::x3d:
      return write_x3d(file, pictures, SceneNotation::x3d);
    case WalkFormat::gl:
      return write_gl(file, pictures);
  }
  return {};
}

}  // namespace mobil
