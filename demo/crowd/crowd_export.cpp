#include "demo/crowd/crowd_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "assets/body/anthropometry.h"
#include "assets/export/gltf_writer.h"
#include "assets/export/usd_writer.h"
#include "assets/surfaces/figure_shapes.h"
#include "demo/crowd/crowd_mannequin.h"
#include "demo/program/commands.h"
#include "systems/surfaces/far_figure.h"

namespace mobil {
namespace {

constexpr double recorded_frame_s = 1.0 / 30;

/// Linear, from sRGB.
Vec3<float> linear_colour(const Colour& shown) {
  const auto decode = [](float x) { return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F); };
  return {decode(shown.red), decode(shown.green), decode(shown.blue)};
}

Result<RecordedFigure> mannequin_figure() {
  const auto body = make_body(far_body);
  if (!body) return tl::unexpected(body.error());
  RecordedFigure figure;
  figure.surfaces = make_figure_shapes(*body);
  for (const BoneSurface& surface : figure.surfaces) {
    figure.cloth.push_back(static_cast<std::size_t>(cloth_of(surface.segment)));
  }
  return figure;
}

Result<void> record_poses(const CrowdScene& scene, CrowdRecording& recording) {
  for (std::size_t i = 0; i < scene.walkers().size(); ++i) {
    const auto pose = scene.simulation().get<Pose>(scene.walkers()[i].entity);
    if (!pose) return fail(fmt::format("{} has left", recording.people[i].name));
    recording.people[i].frames.push_back(*pose);
  }
  return {};
}

}  // namespace

Result<void> check_crowd_exports(const std::vector<std::filesystem::path>& files) {
  std::set<std::filesystem::path> taken;
  for (const auto& file : files) {
    const auto ending = file.extension();
    if (ending != ".glb" && ending != ".usda") {
      return fail(fmt::format("--export {}: ends in no format of crowds; there are .glb, .usda", file.string()));
    }
    if (!taken.insert(file).second) {
      return fail(fmt::format("--export {}: is given twice; leave one out", file.string()));
    }
    if (auto place = check_result_place("--export", file); !place) return place;
  }
  return {};
}

Result<CrowdRecording> record_crowd(CrowdScene& scene, double seconds, const CrowdScene::Progress& progress) {
  CrowdRecording recording;
  recording.frame_s = static_cast<float>(recorded_frame_s);
  auto figure = mannequin_figure();
  if (!figure) return tl::unexpected(figure.error());
  recording.figures.push_back(std::move(*figure));
  for (const CrowdWalker& walker : scene.walkers()) {
    RecordedPerson& person = recording.people.emplace_back();
    person.name = fmt::format("person_{}", walker.number);
    const auto size = scene.simulation().get<BodySize>(walker.entity);
    if (!size) return fail(fmt::format("{} has left", person.name));
    person.scale = far_scale(size->height_m, size->mass_kg);
    for (const Colour& colour : mannequin_colours(walker.number)) person.colours.push_back(linear_colour(colour));
  }
  const auto frames = static_cast<std::size_t>(std::max(1L, std::lround(seconds / recorded_frame_s)));
  const auto ticks_a_frame = std::lround(recorded_frame_s / scene.simulation().tick_s());
  for (std::size_t f = 0; f < frames; ++f) {
    for (long tick = 0; f > 0 && tick < ticks_a_frame; ++tick) {
      if (auto done = scene.decide(); !done) return tl::unexpected(done.error());
      scene.choose_methods();
      scene.tick();
    }
    if (auto done = record_poses(scene, recording); !done) return tl::unexpected(done.error());
    if (progress) progress("recording", f + 1, frames);
  }
  return recording;
}

Result<void> write_crowd_exports(const CrowdRecording& recording, const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) {
    Result<void> done;
    if (file.extension() == ".glb") {
      const auto written = write_glb(file, recording);
      if (!written) done = tl::unexpected(written.error());
    } else {
      done = write_usda(file, recording);
    }
    if (!done) return fail("--export " + done.error().message);
    say_written(file);
  }
  return {};
}

}  // namespace mobil
