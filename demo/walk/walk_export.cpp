#include "demo/walk/walk_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <mobil/anthropometry.h>
#include <mobil/assets/export/recorded_axes.h>
#include <mobil/assets/export/root_motion.h>
#include <mobil/systems/gait/resolve_gait.h>
#include <mobil/systems/poses/roots.h>

namespace mobil {
namespace {

constexpr std::uint32_t warm_up_strides = 4;

/// Returns the recording without bones and muscles.
WalkRecording without_anatomy(const WalkRecording& recording) {
  WalkRecording skin;
  skin.frame_s = recording.frame_s;
  skin.frames = recording.frames;
  skin.name = recording.name;
  skin.start_s = recording.start_s;
  skin.skin = recording.skin;
  skin.standing_m = recording.standing_m;
  skin.colours = recording.colours;
  skin.root = recording.root;
  skin.facts = recording.facts;
  skin.loops = recording.loops;
  skin.z_back = recording.z_back;
  return skin;
}

}  // namespace

Result<WalkTiming> walk_timing(const WalkOptions& options) {
  WalkTiming timing;
  if (options.cycle == 0) {
    timing.ticks = static_cast<std::uint32_t>(std::lround(options.seconds / timing.tick_s));
    return timing;
  }
  Simulation simulation;
  const auto entity = simulation.spawn(options.body, options.gait);
  if (!entity) return tl::unexpected(entity.error());
  const float frequency_hz = simulation.person(*entity)->gait.step_frequency_hz;
  if (!(simulation.person(*entity)->gait.speed_m_s > 0) || !(frequency_hz > 0))
    return fail("--cycle: standing people have no strides; give --speed more than 0, or remove it");
  const double stride_s = 2 / static_cast<double>(frequency_hz);
  const auto frames = static_cast<std::uint32_t>(std::max(1L, std::lround(30 * stride_s)));
  timing.tick_s = stride_s / (2 * frames);
  timing.warm_up_ticks = 2 * frames * warm_up_strides;
  timing.ticks = 2 * frames * static_cast<std::uint32_t>(options.cycle) + 1;
  return timing;
}

RecordedFacts recorded_facts(const BodyRequest& body, const Gait<float>& gait, float heading_rad) {
  const bool walks = gait.speed_m_s > 0 && gait.step_frequency_hz > 0;
  return {body.sex == Sex::woman ? "woman" : "man", body.height_m, body.mass_kg, heading_rad,
          walks ? 2 / gait.step_frequency_hz : 0,   gait.speed_m_s};
}

Result<void> record_root(const Simulation& simulation, Entity person, std::vector<RecordedRoot>& root) {
  Root now;
  if (auto done = simulation.roots({&person, 1}, {&now, 1}); !done) return done;
  root.push_back({now.x_m, now.z_m, now.heading_rad});
  return {};
}

Result<void> close_walk(WalkRecording& recording) {
  constexpr double steady_joints_m = 1e-4, steady_muscles_m = 2e-3;
  const CycleGap gap = close_cycle(recording);
  if (gap.joints_m > steady_joints_m || gap.muscles_m > steady_muscles_m) {
    return fail(
        fmt::format("--cycle: after its strides joints are {:.2f} mm and muscles {:.2f} mm from where they "
                    "began; choose a gait without limits passed, or --method static",
                    1e3 * gap.joints_m, 1e3 * gap.muscles_m));
  }
  return {};
}

void record_drawn_skin(DrawnSkin skin, WalkRecording& recording) {
  std::map<std::array<float, 3>, std::size_t> vertex;
  for (std::size_t v = 0; v < skin.skin->rest.size(); ++v) {
    const Vec3<float>& p = skin.skin->rest[v];
    vertex.try_emplace({p.x, p.y, p.z}, v);
  }
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    skin.pose(recording.frames[f], muscles_of(recording, f));
    for (SkinnedSurface& surface : recording.skin) {
      if (skin.own && &surface == &recording.skin.back()) {
        surface.drawn_m.push_back(skin.own_position);
        continue;
      }
      auto& drawn = surface.drawn_m.emplace_back();
      drawn.reserve(surface.position.size());
      for (const Vec3<float>& p : surface.position) drawn.push_back(skin.position[vertex.at({p.x, p.y, p.z})]);
    }
  }
}

WalkFiles walk_files(WalkRecording pictures, WalkRecording ticks, const WalkOptions& options) {
  WalkFiles files{std::move(pictures), std::move(ticks), {}};
  for (WalkRecording* const one : {&files.pictures, &files.ticks}) {
    if (one->frames.empty()) continue;
    if (options.way == WalkWay::in_place) put_in_place(*one);
    if (options.way == WalkWay::pelvis) one->root.clear();
  }
  if (options.z_back) put_z_back(files.pictures);
  if (options.skin && !options.skin_anatomy) files.dressed = without_anatomy(files.pictures);
  return files;
}

}  // namespace mobil
