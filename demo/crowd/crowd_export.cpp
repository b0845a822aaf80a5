#include "demo/crowd/crowd_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <mobil/assets/export/recorded_skin.h>
#include <mobil/gltf_writer.h>
#include <mobil/skin_writer.h>
#include <mobil/usd_writer.h>
#include "demo/program/commands.h"
#include "demo/walk/drawn_skin.h"

namespace mobil {
namespace {

constexpr double recorded_frame_s = 1.0 / 30;

/// Which of a recording's figures somebody looks like: one for each skin.
std::size_t figure_of(const BodySkin& skin, std::map<const BodySkin*, std::size_t>& known, CrowdRecording& recording) {
  const auto [found, is_new] = known.try_emplace(&skin, recording.figures.size());
  if (is_new) recording.figures.push_back({{}, {}, recorded_skin(skin), standing_of(skin)});
  return found->second;
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
  recording.frame_s = recorded_frame_s;
  BodySkins skins;
  std::map<const BodySkin*, std::size_t> known;
  for (const CrowdWalker& walker : scene.walkers()) {
    RecordedPerson& person = recording.people.emplace_back();
    person.name = fmt::format("person_{}", walker.number);
    const auto human = scene.simulation().human(walker.entity);
    if (!human) return fail(fmt::format("{} has left", person.name));
    const auto shape = skins.of(human->body.request, SkinDetail::far);
    if (!shape) return tl::unexpected(shape.error());
    person.figure = figure_of(*shape->skin, known, recording);
    person.scale = {shape->lengths, shape->lengths, shape->lengths};
    for (const Colour& colour : skin_colours(walker.number)) person.colours.push_back(linear_colour(colour));
  }
  const auto frames =
      static_cast<std::size_t>(std::max(1L, std::lround(seconds / recorded_frame_s))) + 1;  // the first at 0
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
