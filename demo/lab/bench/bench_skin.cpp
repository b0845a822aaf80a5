// People's skin and clothes in a vertex buffer, from their poses on; and how far muscles lift it.

#include <fmt/format.h>

#include <span>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/simulation.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include "demo/lab/bench/bench.h"

namespace mobil {
namespace {

// One frame's map of position and normal (18 + 15), the normal's length (8) and by that (3).
constexpr double vertex_flops = 18 + 15 + 8 + 3;

Result<void> time_skin(BenchRun& run, const std::string& name, std::size_t count, SkinDetail detail) {
  Simulation simulation;
  BodySkins skins;
  const auto shape = skins.of({}, detail);
  if (!shape) return tl::unexpected(shape.error());
  const std::size_t vertices = shape->skin->rest.size(), stride = 24;
  std::vector<std::byte> buffer(count * vertices * stride);
  std::vector<SkinRequest> requests;
  for (std::size_t i = 0; i < count; ++i) {
    const auto entity = simulation.spawn({});
    if (!entity) return tl::unexpected(entity.error());
    const std::span own = std::span(buffer).subspan(i * vertices * stride, vertices * stride);
    requests.push_back({*entity, *shape, {own, stride}, {own.subspan(12), stride}});
  }
  simulation.advance(0.2);
  SkinWriter writer;
  if (auto done = writer.write(simulation.world(), requests); !done) return done;
  const Measured time = measure_short([&] { (void)writer.write(simulation.world(), requests); });
  const double all = static_cast<double>(count * vertices);
  BenchResult& result = run.add_time(name, time, all, 1e-9, "ns");
  result.of_peak = vertex_flops / result.value / run.machine.fma_peak_gflops;
  result.bound =
      fmt::format("{} vertices of {} people, {} frames each; {:.0f} us a person", count * vertices, count,
                  skin_mesh(Sex::man, detail).frame.size(), result.value * 1e-3 * static_cast<double>(vertices));
  return {};
}

/// One leg's cover from all that is drawn of its muscles.
Result<void> time_cover(BenchRun& run) {
  Simulation simulation;
  const auto entity = simulation.spawn({});
  if (!entity) return tl::unexpected(entity.error());
  if (auto done = simulation.add_leg_muscles(*entity); !done) return done;
  const Human human = *simulation.human(*entity);
  const auto bound = bind_surfaces(human.body, {.bones = false, .sides = {true, false}});
  if (!bound) return tl::unexpected(bound.error());
  std::vector<SurfaceMuscle> muscles;
  for (const HumanMuscle& own : human.muscles) muscles.push_back({own.plan.muscle, own.entity});
  simulation.advance(0.2);
  std::vector<Vec3<float>> position(bound->vertices);
  SurfaceRequest request{*entity, muscles, &*bound};
  request.positions.bytes = std::as_writable_bytes(std::span(position));
  SurfaceWriter writer;
  if (auto done = writer.write(simulation.world(), {&request, 1}); !done) return done;
  BodySkins skins;
  const auto shape = skins.of({}, SkinDetail::near);
  if (!shape) return tl::unexpected(shape.error());
  const Pose<float> pose = *simulation.get<Pose>(*entity);
  SkinCover cover;
  const Measured time = measure_short(
      [&] { cover_muscles(*shape->skin, pose, shape->lengths, Side::right, position, cover.lift_m[Side::right]); });
  BenchResult& result = run.add_time("skin.cover.us_per_leg", time, 1, 1e-6, "us");
  result.bound = fmt::format("{} vertices of muscle", position.size());
  return {};
}

/// One leg's cover where nobody simulates its muscles.
Result<void> time_table(BenchRun& run) {
  SkinTables tables;
  const auto table = tables.of({});
  if (!table) return tl::unexpected(table.error());
  Simulation simulation;
  const auto entity = simulation.spawn({});
  if (!entity) return tl::unexpected(entity.error());
  simulation.advance(0.2);
  const Pose<float> pose = *simulation.get<Pose>(*entity);
  SkinCover cover;
  const Measured time =
      measure_short([&] { cover_by_table(**table, leg_angles_of(pose, Side::right), cover.lift_m[Side::right]); });
  BenchResult& result = run.add_time("skin.table.us_per_leg", time, 1, 1e-6, "us");
  result.of_peak = 2.0 * skin_modes * leg_grid_points * 1e-3 / result.value / run.machine.fma_peak_gflops;
  result.bound = fmt::format("{} modes of {} points", skin_modes, leg_grid_points);
  return {};
}

}  // namespace

Result<void> bench_skin(BenchRun& run) {
  for (const auto& [name, count, detail] :
       {std::tuple{"skin.hero.ns_per_vertex", std::size_t{1}, SkinDetail::hero},
        std::tuple{"skin.near.ns_per_vertex", std::size_t{1}, SkinDetail::near},
        std::tuple{"skin.hundred_far.ns_per_vertex", std::size_t{100}, SkinDetail::far},
        std::tuple{"skin.thousand_distant.ns_per_vertex", std::size_t{1000}, SkinDetail::distant}}) {
    if (auto done = time_skin(run, name, count, detail); !done) return done;
  }
  if (auto done = time_cover(run); !done) return done;
  return time_table(run);
}

}  // namespace mobil
