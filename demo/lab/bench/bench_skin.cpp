// People's skin and clothes in a vertex buffer, from their poses on; and how far muscles lift it.

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>
#include <vector>

#include <mobil/anthropometry.h>
#include <mobil/engine/jobs.h>
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

/// One leg's cover from all that is drawn of its muscles, or a tenth.
Result<void> time_cover(BenchRun& run, const std::string& name, double detail) {
  Simulation simulation;
  const auto entity = simulation.spawn({});
  if (!entity) return tl::unexpected(entity.error());
  if (auto done = simulation.add_leg_muscles(*entity); !done) return done;
  const Human human = *simulation.human(*entity);
  const auto bound = bind_surfaces(human.body, {.bones = false, .sides = {true, false}, .detail = detail});
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
  BenchResult& result = run.add_time(name, time, 1, 1e-6, "us");
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

/// A frame of 500 people with skin and clothes on all cores, 50 of them near, with muscles that move under it.
Result<void> time_crowd(BenchRun& run) {
  constexpr std::size_t all = 500, near = 50;
  const Threads threads;
  Simulation simulation;
  BodySkins skins;
  std::vector<SpawnRequest> asked(all);
  for (std::size_t i = 0; i < all; ++i) {
    asked[i].body.height_m = 1.60F + 0.02F * static_cast<float>(i % 13);
    asked[i].body.mass_kg = asked[i].body.height_m * asked[i].body.height_m * (20 + static_cast<float>(i % 9));
    asked[i].body.sex = i % 2 == 0 ? Sex::man : Sex::woman;
    asked[i].x_m = static_cast<float>(i % 25);
    asked[i].z_m = static_cast<float>(i / 25);
    if (i < near) asked[i].muscles = LegMuscles{};
  }
  std::vector<Entity> entity(all);
  if (auto done = simulation.spawn(asked, entity); !done) return done;
  // Each side's muscles by themselves, a tenth of their triangles.
  std::vector<BodySurfaces> bound;
  for (const bool is_left : {false, true}) {
    auto side = bind_surfaces(make_body({}).value(), {.bones = false, .sides = {!is_left, is_left}, .detail = 0.1});
    if (!side) return tl::unexpected(side.error());
    bound.push_back(std::move(*side));
  }
  struct Near {
    std::vector<SurfaceMuscle> muscles;
    std::array<SurfaceFit, 2> fit;
    std::array<std::vector<Vec3<float>>, 2> drawn;
  };
  std::vector<Near> looked_at(near);
  std::vector<SurfaceRequest> surfaces;
  std::vector<std::vector<std::byte>> buffer(all);
  std::vector<SkinRequest> requests;
  for (std::size_t i = 0; i < all; ++i) {
    const auto shape = skins.of(asked[i].body, i < near ? SkinDetail::near : SkinDetail::far);
    if (!shape) return tl::unexpected(shape.error());
    buffer[i].resize(24 * shape->skin->rest.size());
    SkinRequest& request = requests.emplace_back();
    request = {entity[i], *shape, {buffer[i], 24}, {std::span(buffer[i]).subspan(12), 24}};
    if (i >= near) continue;
    Near& one = looked_at[i];
    const Human human = *simulation.human(entity[i]);
    for (const HumanMuscle& own : human.muscles) one.muscles.push_back({own.plan.muscle, own.entity});
    for (const Side side : {Side::right, Side::left}) {
      one.fit[side] = fit_surfaces(bound[side], human.body);
      one.drawn[side].resize(bound[side].vertices);
      SurfaceRequest surface{entity[i], one.muscles, &bound[side]};
      surface.positions.bytes = std::as_writable_bytes(std::span(one.drawn[side]));
      surface.fit = &one.fit[side];
      surfaces.push_back(surface);
      request.muscles[side] = one.drawn[side];
    }
  }
  simulation.advance(0.2);
  SurfaceWriter surface_writer;
  SkinWriter skin_writer;
  const auto frame = [&] {
    (void)surface_writer.write(simulation.world(), surfaces, threads.jobs());
    (void)skin_writer.write(simulation.world(), requests, threads.jobs());
  };
  if (auto done = surface_writer.write(simulation.world(), surfaces); !done) return done;
  if (auto done = skin_writer.write(simulation.world(), requests); !done) return done;
  const Measured time = measure_short(frame);
  BenchResult& result = run.add_time("skin.five_hundred.ms_per_frame", time, 1, 1e-3, "ms");
  result.bound = fmt::format("on {} cores; {} near, with a tenth of their muscles' vertices", threads.count(), near);
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
  if (auto done = time_cover(run, "skin.cover.us_per_leg", 1); !done) return done;
  if (auto done = time_cover(run, "skin.cover.tenth.us_per_leg", 0.1); !done) return done;
  if (auto done = time_table(run); !done) return done;
  return time_crowd(run);
}

}  // namespace mobil
