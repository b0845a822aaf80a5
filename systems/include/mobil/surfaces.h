#pragma once
// People's surfaces as vertices: positions and unit normals into the caller's buffers.
//
//   const auto bound = bind_surfaces(usual);                    // once: part, index, vertices (body_surfaces.h)
//   const auto fit = fit_surfaces(*bound, body);                // each body
//   SurfaceWriter writer;                                       // keeps what it works in
//   SurfaceRequest one{person, muscles, &*bound, {buffer, 24}, {buffer.subspan(12), 24}, {}, &fit};
//   writer.write(simulation.world(), {&one, 1}, jobs);          // each frame
//
// Triangles never change. Normals are the means of the vertices' triangles' normals weighted by their areas, on the
// surface as it is deformed now.

#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/body_surfaces.h>
#include <mobil/systems/surfaces/vertex_stream.h>

namespace mobil::inline v0_3 {

/// One of a person's muscles, by Side: of Simulation::person, or of Simulation::muscle for each side.
struct SurfaceMuscle {
  Muscle muscle{};
  std::array<Entity, 2> entity;
};

/// One person, with the surfaces of a body like theirs. Positions in m, world axes, from `origin_m`, which is
/// subtracted before anything is placed: far from the world's origin give a point near the person, for floats are half
/// a millimetre apart at 8 km. Normals may be left out (no bytes), and tangents, which are four floats a vertex (stride
/// at least 16), as glTF has them: the unit direction in which TexturePlace::along grows, at right angles to the
/// normal, and ±1, of the side of normal × tangent where `around` grows. They need surfaces that were chosen
/// `textured`.
struct SurfaceRequest {
  Entity person;
  std::span<const SurfaceMuscle> muscles;  // all that drive the surfaces; more are ignored
  const BodySurfaces* surfaces = nullptr;
  VertexStream positions{}, normals{};
  Vec3<float> origin_m{0, 0, 0};
  const SurfaceFit* fit = nullptr;  // of surfaces that were bound to another body; null: to one like theirs
  VertexStream tangents{{}, 4 * sizeof(float)};
};

/// Writes the vertices of bones and muscles for many people at once. It keeps what it works in; one thread uses it at a
/// time.
class SurfaceWriter {
 public:
  explicit SurfaceWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes each request's vertices, as they are after the last tick, with `jobs`; the same bytes for any number of
  /// threads. Streams of different requests must not lie over each other, which is not looked at. A muscle without
  /// control points (Method::none, or nobody asked for them) is drawn as it is at rest, as much longer as its line is.
  /// Takes memory only where there are more requests or larger surfaces than ever before. Errors, in one line that
  /// names the request, before anything is written: a stale person or muscle; a person without a pose (Status::missing:
  /// who is compact or asleep); a driving muscle that is not in the list, another person's, or of other cells than the
  /// surfaces were bound to; a stride or a buffer that is too small, streams that lie over each other, tangents without
  /// normals or of surfaces that are not textured.
  Result<void> write(const World& world, std::span<const SurfaceRequest> requests, const Jobs& jobs = {});

 private:
  struct Line {
    const float* line = nullptr;  // a lane of LineOfAction
    const float* pull = nullptr;  // and of Musculotendon; null: none
    const float* node = nullptr;  // and of control points; null: none
  };
  struct Resolved {
    const float* pose = nullptr;  // a lane of Pose
    std::size_t first_line = 0;   // two a driver
  };
  struct Work;

  Result<void> resolve(const World& world, const SurfaceRequest& request);
  static void write_pieces(void* work, std::size_t begin, std::size_t end);

  std::pmr::vector<Resolved> person_;
  std::pmr::vector<Line> line_;
  ScratchPool scratch_;
};

}  // namespace mobil::inline v0_3
