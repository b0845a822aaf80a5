// Skin and clothes in a vertex buffer, starting from poses, and their lift by muscles.
// Surfaces: positions and normals of people's muscles and bones in a vertex buffer, from their control points on.

#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <span>

#include <mobil/anthropometry.h>
#include <mobil/engine/world.h>
#include <mobil/simulation.h>
#include <mobil/skin_tables.h>
#include <mobil/skin_writer.h>
#include <mobil/surfaces.h>
#include <mobil/systems/muscles/person.h>
#include "demo/lab/bench/bench.h"

namespace mobil {
namespace {

// A muscle's vertex: eight nodes' weighted mean (45), its place in the lattice (3), maps of frame and two bones (54),
// their weighted sum (15), its side (1). Its normal: six neighbours' differences (12), two products (21), its length
// (8; root and quotient count as one each), division by it (3).
constexpr double muscle_flops = 45 + 3 + 54 + 15 + 1 + 12 + 21 + 8 + 3;
// Its tangent, in addition: four neighbours' differences (36), orthogonal to the normal (11), its length (8), division
// by it (3).
constexpr double tangent_flops = 36 + 11 + 8 + 3;
constexpr double bone_flops = 18 + 15;  // rotated, and the position shifted

/// A person and the surfaces with which they are drawn.
struct DrawnPerson {
  Entity entity;
  std::vector<SurfaceMuscle> muscles;
  const BodySurfaces* surfaces = nullptr;
};

struct Scene {
  Simulation simulation;
  std::deque<BodySurfaces> surfaces;
  std::vector<DrawnPerson> people;
  double vertices = 0;     // of all people
  double bound_bytes = 0;  // mean inputs of a vertex
};

double bytes_of(const PackedSurface& s) {
  return static_cast<double>(s.node.size() * sizeof(s.node[0]) + s.lattice.size() * sizeof(LatticeBlock) +
                             s.bone.size() * sizeof(BoneBlock) + s.rings.vertex.size() * sizeof(PlacedRing) +
                             s.along.size() * sizeof(PlacedAlong));
}

/// Returns the bytes of all inputs of a person's vertices, each once; both sides share them.
double bytes_of(const BodySurfaces& surfaces) {
  double bytes = 0;
  for (const auto& piece : surfaces.piece) {
    const auto* rigid = std::get_if<RigidSurface>(&piece.surface);
    bytes += rigid != nullptr ? static_cast<double>(rigid->block.size() * sizeof(RigidBlock))
                              : bytes_of(std::get<PackedSurface>(piece.surface));
  }
  return bytes;
}

/// Adds people of one body, with one set of surfaces for all or one for each in memory.
void gather(Scene& scene, std::size_t count, bool shared, const SurfaceChoice& choice) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto entity = must(scene.simulation.spawn({}));
    must(scene.simulation.set_muscles(entity));
    const Person person = *scene.simulation.person(entity);
    if (i == 0) {
      scene.surfaces.push_back(must(bind_surfaces(person.body, choice)));
    } else if (!shared) {
      scene.surfaces.push_back(BodySurfaces(scene.surfaces.front()));
    }
    DrawnPerson drawn{entity, {}, &scene.surfaces.back()};
    for (const PersonMuscle& own : person.muscles) drawn.muscles.push_back({own.plan.muscle, own.entity});
    scene.vertices += drawn.surfaces->vertices;
    scene.people.push_back(std::move(drawn));
  }
  for (const BodySurfaces& surfaces : scene.surfaces) scene.bound_bytes += bytes_of(surfaces) / scene.vertices;
  scene.simulation.advance(0.2);
}

/// Times one way of writing all people. `stride` is the bytes of a vertex (12: positions only; from 24 on normals, from
/// 40 on tangents).
void time_writing(BenchRun& run, const std::string& name, const Scene& scene, std::size_t stride, double flops) {
  std::vector<std::byte> buffer(static_cast<std::size_t>(scene.vertices) * stride);
  std::span<std::byte> free = buffer;
  std::vector<SurfaceRequest> requests;
  for (const DrawnPerson& person : scene.people) {
    SurfaceRequest request{person.entity, person.muscles, person.surfaces};
    request.positions = {free.first(person.surfaces->vertices * stride), stride};
    if (stride >= 24) request.normals = {request.positions.bytes.subspan(12), stride};
    if (stride >= 40) request.tangents = {request.positions.bytes.subspan(24), stride};
    free = free.subspan(person.surfaces->vertices * stride);
    requests.push_back(request);
  }
  SurfaceWriter writer;
  must(writer.write(scene.simulation.world(), requests));
  const Measured time = measure_short([&] { (void)writer.write(scene.simulation.world(), requests); });
  BenchResult& result = run.add_time(name, time, scene.vertices, 1e-9, "ns");
  const double vertex_s = result.value * 1e-9;
  const double bytes = std::round(scene.bound_bytes) + 2 * static_cast<double>(stride);  // a written line is read first
  result.of_peak = flops / vertex_s * 1e-9 / run.machine.fma_peak_gflops;
  result.of_bandwidth = bytes / vertex_s * 1e-9 / run.machine.bandwidth_gbps;
  result.bound = fmt::format("{:.0f} vertices of {} people, {} bytes apart, {:.0f} operations and {:.0f} bytes each",
                             scene.vertices, scene.people.size(), stride, flops, bytes);
}

// One frame's map of position and normal (18 + 15), the normal's length (8), division by it (3).
constexpr double vertex_flops = 18 + 15 + 8 + 3;

void time_skin(BenchRun& run, const std::string& name, std::size_t count, SkinDetail detail) {
  Simulation simulation;
  BodySkins skins;
  const auto shape = must(skins.of({}, detail));
  const std::size_t vertices = shape.skin->rest.size(), stride = 24;
  std::vector<std::byte> buffer(count * vertices * stride);
  std::vector<SkinRequest> requests;
  for (std::size_t i = 0; i < count; ++i) {
    const auto entity = must(simulation.spawn({}));
    const std::span own = std::span(buffer).subspan(i * vertices * stride, vertices * stride);
    requests.push_back({entity, shape, {own, stride}, {own.subspan(12), stride}});
  }
  simulation.advance(0.2);
  SkinWriter writer;
  must(writer.write(simulation.world(), requests));
  const Measured time = measure_short([&] { (void)writer.write(simulation.world(), requests); });
  const double all = static_cast<double>(count * vertices);
  BenchResult& result = run.add_time(name, time, all, 1e-9, "ns");
  result.of_peak = vertex_flops / result.value / run.machine.fma_peak_gflops;
  result.bound =
      fmt::format("{} vertices of {} people, {} frames each; {:.0f} us a person", count * vertices, count,
                  skin_mesh(Sex::man, detail).frame.size(), result.value * 1e-3 * static_cast<double>(vertices));
}

/// Times one leg's cover from all drawn muscles.
void time_cover(BenchRun& run) {
  Simulation simulation;
  const auto entity = must(simulation.spawn({}));
  must(simulation.set_muscles(entity));
  const Person person = *simulation.person(entity);
  const auto bound = must(bind_surfaces(person.body, {.bones = false, .sides = {true, false}}));
  std::vector<SurfaceMuscle> muscles;
  for (const PersonMuscle& own : person.muscles) muscles.push_back({own.plan.muscle, own.entity});
  simulation.advance(0.2);
  std::vector<Vec3<float>> position(bound.vertices);
  SurfaceRequest request{entity, muscles, &bound};
  request.positions.bytes = std::as_writable_bytes(std::span(position));
  SurfaceWriter writer;
  must(writer.write(simulation.world(), {&request, 1}));
  BodySkins skins;
  const auto shape = must(skins.of({}, SkinDetail::near));
  const Pose<float> pose = *simulation.get<Pose>(entity);
  SkinCover cover;
  const Measured time = measure_short(
      [&] { cover_muscles(*shape.skin, pose, shape.lengths, Side::right, position, cover.lift_m[Side::right]); });
  BenchResult& result = run.add_time("skin.cover.us_per_leg", time, 1, 1e-6, "us");
  result.bound = fmt::format("{} vertices of muscle", position.size());
}

/// Times one leg's cover without simulated muscles.
void time_table(BenchRun& run) {
  SkinTables tables;
  const auto table = must(tables.of({}));
  Simulation simulation;
  const auto entity = must(simulation.spawn({}));
  simulation.advance(0.2);
  const Pose<float> pose = *simulation.get<Pose>(entity);
  SkinCover cover;
  const Measured time =
      measure_short([&] { cover_by_table(*table, leg_angles_of(pose, Side::right), cover.lift_m[Side::right]); });
  BenchResult& result = run.add_time("skin.table.us_per_leg", time, 1, 1e-6, "us");
  result.of_peak = 2.0 * skin_modes * leg_grid_points * 1e-3 / result.value / run.machine.fma_peak_gflops;
  result.bound = fmt::format("{} modes of {} points", skin_modes, leg_grid_points);
}

}  // namespace

void bench_skinning(BenchRun& run) {
  const SurfaceChoice muscles{.bones = false}, bones{.simulated = {}}, textured{.bones = false, .textured = true};
  constexpr std::size_t many = 100;
  struct Way {
    const char* name;
    std::size_t people;
    bool shared;
    const SurfaceChoice& choice;
    std::size_t stride;
    double flops;
  };
  for (const Way& way : {Way{"skinning.ns_per_vertex", 1, true, muscles, 24, muscle_flops},
                         Way{"skinning.hundred_shared.ns_per_vertex", many, true, muscles, 24, muscle_flops},
                         Way{"skinning.hundred_own.ns_per_vertex", many, false, muscles, 24, muscle_flops},
                         Way{"skinning.tangents.ns_per_vertex", 1, true, textured, 40, muscle_flops + tangent_flops},
                         Way{"skinning.bones.ns_per_vertex", 1, true, bones, 24, bone_flops}}) {
    Scene scene;
    gather(scene, way.people, way.shared, way.choice);
    time_writing(run, way.name, scene, way.stride, way.flops);
  }
}

void bench_skin(BenchRun& run) {
  for (const auto& [name, count, detail] :
       {std::tuple{"skin.hero.ns_per_vertex", std::size_t{1}, SkinDetail::hero},
        std::tuple{"skin.near.ns_per_vertex", std::size_t{1}, SkinDetail::near},
        std::tuple{"skin.hundred_far.ns_per_vertex", std::size_t{100}, SkinDetail::far},
        std::tuple{"skin.thousand_distant.ns_per_vertex", std::size_t{1000}, SkinDetail::distant}}) {
    time_skin(run, name, count, detail);
  }
  time_cover(run);
  time_table(run);
}

}  // namespace mobil
