#include <mobil/assets/import/anatomy_folder.h>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include <mobil/mesh_file.h>
#include "assets/import/anatomy_manifest.h"
#include "assets/import/mesh_check.h"
#include "assets/import/mesh_place.h"
#include "assets/import/simplify_surface.h"

namespace mobil::inline v0_3 {
namespace {

/// A row's mesh, complete and in mobil's frame, and its box in the file's.
struct LoadedMesh {
  SurfaceMesh mesh;
  MeshBox raw, box;
};

tl::unexpected<Error> fault_of(const ManifestRow& row, std::string_view what) {
  return fail(fmt::format("{} ({}): {}", row.file, row.where, what));
}

/// Reads a row's mesh and mends it. The part's report has the known data of it in any case.
Result<LoadedMesh> load_mesh(ManifestRow& row, const LandmarkTable& table, const AnatomyOptions& options) {
  SurfaceReport& report = row.part.report;
  auto file = read_mesh(row.file);
  if (!file) return fail(fmt::format("{} ({})", file.error().message, row.where));
  report.triangles = file->triangles_in_file;
  report.said = file->said;
  if (row.triangles && *row.triangles != file->triangles_in_file) {
    return fail(
        fmt::format("{}: {} triangles, {} says {}; the file may be cut short: copy it again, or mend the manifest",
                    row.file, file->triangles_in_file, row.where, *row.triangles));
  }
  LoadedMesh loaded{std::move(file->mesh), {}, {}};
  SurfaceMesh& mesh = loaded.mesh;
  if (auto done = check_edges(mesh, report); !done) return fault_of(row, done.error().message);
  if (row.watertight && report.open_edges > 0) {
    return fail(
        fmt::format("{}: {} open edges where {} says watertight; the file may be damaged: copy it again, close "
                    "the holes, or write 'no' there",
                    row.file, report.open_edges, row.where));
  }
  loaded.raw = box_of(mesh);
  for (auto& p : mesh.position) {
    p = to_mobil(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z), row.frame);
  }
  loaded.box = box_of(mesh);
  if (const auto wrong = misplaced(loaded.box, row.part, table.landmarks, {})) {
    return fault_of(row, *wrong + frames_that_fit(loaded.raw, row.part, table.landmarks, {}));
  }
  if (!row.part.midline) {
    if (auto done = keep_right_side(mesh, table.landmarks.middle_x, report); !done) {
      return fault_of(row, done.error().message);
    }
    loaded.box = box_of(mesh);
  }
  if (auto done = mend_and_check(mesh, row.part.kind, options.speck_share, report); !done) {
    return fault_of(row, done.error().message);
  }
  return loaded;
}

/// Writes the part with its mesh simplified by `options`.
Result<void> finish_part(const ManifestRow& row, const LoadedMesh& loaded, const AnatomyOptions& options,
                         AnatomyPart& part) {
  const bool bone = part.kind == AnatomyKind::bone;
  SurfaceMesh light = clustered(loaded.mesh, bone ? options.bone_cell_m : options.muscle_cell_m);
  if (light.triangle.empty()) {
    return fault_of(row, "no triangle is left after simplification; choose cells smaller than the mesh");
  }
  light.name = std::move(part.mesh.name);
  part.mesh = std::move(light);
  return {};
}

/// Calls `work` with each number below `count`, on several threads.
template <class Work>
void on_threads(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::thread> helpers;
  for (unsigned t = 1; t < threads; ++t) helpers.emplace_back(take);
  take();
  for (auto& helper : helpers) helper.join();
}

void survey_rows(std::vector<ManifestRow>& row, const LandmarkTable& table, const AnatomyOptions& options,
                 AnatomySurvey& survey) {
  std::vector<Result<LoadedMesh>> loaded(row.size(), fail("not read"));
  on_threads(row.size(), options.threads, [&](std::size_t i) { loaded[i] = load_mesh(row[i], table, options); });
  std::vector<PlacedBone> bones;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (loaded[i] && row[i].part.kind == AnatomyKind::bone) bones.push_back({row[i].part.origin, loaded[i]->box});
  }
  survey.mesh.resize(row.size());
  on_threads(row.size(), options.threads, [&](std::size_t i) {
    SurveyedMesh& mesh = survey.mesh[i];
    mesh.file = row[i].name;
    mesh.part = std::move(row[i].part);
    Result<void> done;
    if (!loaded[i]) {
      done = tl::unexpected(loaded[i].error());
    } else if (const auto wrong = misplaced(loaded[i]->box, mesh.part, table.landmarks, bones)) {
      done = fault_of(row[i], *wrong + frames_that_fit(loaded[i]->raw, mesh.part, table.landmarks, bones));
    } else {
      done = finish_part(row[i], *loaded[i], options, mesh.part);
    }
    if (!done) mesh.fault = std::move(done.error());
    loaded[i] = fail("taken");
  });
}

}  // namespace

AnatomySurvey survey_anatomy(const std::string& folder, const AnatomyOptions& options) {
  AnatomySurvey survey;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    survey.faults.push_back(
        fmt::format("{}: no such folder; name one that holds manifest.csv, landmarks.csv and the meshes", folder));
    return survey;
  }
  const auto table = read_landmarks(folder);
  if (!table) {
    survey.faults.push_back(table.error().message);
    return survey;
  }
  survey.anatomy.metres_per_unit = table->frame.metres_per_unit;
  survey.anatomy.landmarks = table->landmarks;
  survey.anatomy.said = table->said;
  auto manifest = read_manifest(folder, table->frame, options);
  if (!manifest) {
    survey.faults.push_back(manifest.error().message);
    return survey;
  }
  survey.faults = std::move(manifest->faults);
  survey_rows(manifest->row, *table, options, survey);
  return survey;
}

Result<Anatomy> load_anatomy(const std::string& folder, const AnatomyOptions& options) {
  AnatomySurvey survey = survey_anatomy(folder, options);
  if (!survey.faults.empty()) return fail(std::move(survey.faults.front()));
  for (SurveyedMesh& mesh : survey.mesh) {
    if (mesh.fault) return tl::unexpected(std::move(*mesh.fault));
    survey.anatomy.part.push_back(std::move(mesh.part));
  }
  return std::move(survey.anatomy);
}

}  // namespace mobil::inline v0_3
