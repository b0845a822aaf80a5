#include <mobil/gltf_writer.h>

#include <fmt/format.h>

#include <mobil/assets/files/output_file.h>
#include "assets/export/gltf_person.h"
#include "assets/export/recording_check.h"

namespace mobil::inline v0_3 {
namespace {

Result<void> check_options(const ExportOptions& options) {
  if (options.morph_targets < 0 || options.morph_targets > 8) {
    return fail(fmt::format("{} morph targets a muscle; the range is 0–8", options.morph_targets));
  }
  if (!(options.morph_tolerance_m >= 0.0F && options.morph_tolerance_m <= 1.0F)) {
    return fail(fmt::format("morph tolerance {} m; the range is 0–1 m", options.morph_tolerance_m));
  }
  return {};
}

/// Returns the bytes of the file.
Result<std::string> encode_people(const RecordedPeople& recorded, const ExportOptions& options, ExportReport& report) {
  if (auto ok = check_options(options); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_recording(recorded); !ok) return tl::unexpected(ok.error());

  GltfScene scene;
  tinygltf::Model& model = scene.draft.model;
  model.asset.version = "2.0";
  model.asset.generator = "mobil";
  scene.animation.animation.name = "walk";
  scene.animation.frames = recorded.people.front().frames->size();
  scene.animation.frame_s = recorded.frame_s;
  scene.scene.name = "walk";
  for (const SeenPerson& person : recorded.people) {
    auto added = add_person(scene, person, recorded.figures[person.figure], recorded.prefix(person), options, report);
    if (!added) return tl::unexpected(added.error());
  }
  model.scenes.push_back(std::move(scene.scene));
  model.defaultScene = 0;
  if (!scene.animation.animation.channels.empty()) model.animations.push_back(std::move(scene.animation.animation));
  return glb_bytes(scene.draft);
}

Result<ExportReport> write_people(const std::filesystem::path& path, const RecordedPeople& recorded,
                                  const ExportOptions& options) {
  ExportReport report;
  const auto bytes = encode_people(recorded, options, report);
  if (!bytes) return fail(fmt::format("{}: {}", path.string(), bytes.error().message));
  report.bytes = bytes->size();
  if (auto ok = write_file(path, *bytes); !ok) return tl::unexpected(ok.error());
  return report;
}

}  // namespace

Result<ExportReport> write_glb(const std::filesystem::path& path, const WalkRecording& recording,
                               const ExportOptions& options) {
  return write_people(path, recorded_people(recording), options);
}

Result<ExportReport> write_glb(const std::filesystem::path& path, const CrowdRecording& recording,
                               const ExportOptions& options) {
  return write_people(path, recorded_people(recording), options);
}

}  // namespace mobil::inline v0_3
