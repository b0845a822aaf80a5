#include "assets/import/anatomy_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <thread>

#include "assets/import/anatomy_manifest.h"
#include "assets/import/mesh_file.h"
#include "assets/import/simplify_surface.h"
#include "assets/surfaces/surface_mesh.h"

namespace mobil {
namespace {

constexpr double reach_limit_m = 1.5;
constexpr double smallest_extent_m = 0.002;

/// In one unit with the landmarks: neither far away nor a speck.
Result<void> check_place(const ManifestRow& row, const SurfaceMesh& mesh, const AnatomyLandmarks& landmarks) {
  double reach = 0, extent = 0;
  const auto& first = mesh.position.front();
  for (const auto& p : mesh.position) {
    const auto& h = landmarks.hip;
    reach = std::max<double>(reach, std::hypot(p.x - h.x, p.y - h.y, p.z - h.z));
    extent = std::max<double>(extent, std::hypot(p.x - first.x, p.y - first.y, p.z - first.z));
  }
  if (reach <= reach_limit_m && extent >= smallest_extent_m) return {};
  return fail(
      fmt::format("{} ({}): reaches {:.4g} m from the hip and is {:.4g} m large; valid: at most {} m and at least "
                  "{} m: write every mesh in the units and frame of landmarks.csv",
                  row.file, row.where, reach, extent, reach_limit_m, smallest_extent_m));
}

Result<SurfaceMesh> load_mesh(const ManifestRow& row, const LandmarkTable& frame, const AnatomyOptions& options) {
  auto file = read_mesh(row.file);
  if (!file) return fail(fmt::format("{} ({})", file.error().message, row.where));
  if (row.triangles && *row.triangles != file->triangles_in_file) {
    return fail(
        fmt::format("{}: {} triangles, {} says {}; the file may be cut short: copy it again, or mend the manifest",
                    row.file, file->triangles_in_file, row.where, *row.triangles));
  }
  SurfaceMesh& mesh = file->mesh;
  const EdgeCount edges = count_edges(mesh);
  if (edges.overused > 0) {
    return fail(
        fmt::format("{} ({}): {} edges are used by more than two triangles, valid: 0; take the extra faces away "
                    "or split the edges in a mesh editor",
                    row.file, row.where, edges.overused));
  }
  if (row.watertight && edges.border > 0) {
    return fail(
        fmt::format("{}: {} open edges where {} says watertight; the file may be damaged: copy it again, close "
                    "the holes, or write 'no' there",
                    row.file, edges.border, row.where));
  }
  for (auto& p : mesh.position) p = to_mobil(p.x, p.y, p.z, frame.metres_per_unit);
  if (auto place = check_place(row, mesh, frame.landmarks); !place) return fail(place.error().message);
  if (edges.border == 0 && enclosed_volume(mesh) < 0) turn_over(mesh.triangle);
  const bool bone = row.part.kind == AnatomyKind::bone;
  if (!bone) remove_specks(mesh, options.speck_share);
  SurfaceMesh light = clustered(mesh, bone ? options.bone_cell_m : options.muscle_cell_m);
  if (light.triangle.empty()) {
    return fail(fmt::format("{} ({}): no triangle is left after simplification; choose cells smaller than the mesh",
                            row.file, row.where));
  }
  light.name = row.part.mesh.name;
  return light;
}

}  // namespace

Result<Anatomy> load_anatomy(const std::string& folder, const AnatomyOptions& options) {
  if (!std::filesystem::is_directory(folder)) {
    return fail(
        fmt::format("{}: no such folder; name one that holds manifest.csv, landmarks.csv and the meshes", folder));
  }
  const auto frame = read_landmarks(folder);
  if (!frame) return fail(frame.error().message);
  auto rows = read_manifest(folder, frame->metres_per_unit, options);
  if (!rows) return fail(rows.error().message);

  std::vector<Result<SurfaceMesh>> mesh(rows->size(), fail("not read"));
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < rows->size(); i = next++) mesh[i] = load_mesh((*rows)[i], *frame, options);
  };
  std::vector<std::thread> helpers;
  for (unsigned t = 1; t < options.threads; ++t) helpers.emplace_back(work);
  work();
  for (auto& helper : helpers) helper.join();

  Anatomy anatomy{frame->metres_per_unit, frame->landmarks, {}};
  for (std::size_t i = 0; i < rows->size(); ++i) {
    if (!mesh[i]) return fail(mesh[i].error().message);
    AnatomyPart part = std::move((*rows)[i].part);
    part.mesh = std::move(*mesh[i]);
    anatomy.part.push_back(std::move(part));
  }
  return anatomy;
}

}  // namespace mobil
