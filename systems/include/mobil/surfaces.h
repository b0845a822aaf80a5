#pragma once
// Writes people's bones and muscles as vertices: positions and unit normals into the caller's buffers.
//
//   const auto bound = bind_surfaces(usual);                    // once: part, index, vertices (body_surfaces.h)
//   const auto fit = fit_surfaces(*bound, body);                // each body
//   SurfaceWriter writer;                                       // keeps its scratch memory
//   SurfaceRequest one{person, muscles, &*bound, {buffer, 24}, {buffer.subspan(12), 24}, {}, &fit};
//   writer.write(simulation.world(), {&one, 1}, jobs);          // each frame
//
// Triangles never change. A vertex normal is the area-weighted mean of the normals of its triangles on the deformed
// surface.

#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include <mobil/components/muscle.h>
#include <mobil/components/pose.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/body_surfaces.h>
#include <mobil/systems/surfaces/vertex_stream.h>

namespace mobil::inline v0_3 {

/// One of a person's muscles, with its entity by Side (Simulation::person, or Simulation::muscle for each side).
struct SurfaceMuscle {
  Muscle muscle{};
  std::array<Entity, 2> entity;
};

/// One person, with the surfaces of a similar body. Positions are in m and world axes, unless `write` is given others,
/// relative to `origin_m` (m, world axes), which is subtracted before anything is placed. Far from the world's origin
/// use a point near the person, because floats are 0.5 mm apart at 8 km. Normals and tangents are optional (no bytes).
/// A tangent has four floats (stride at least 16), as in glTF: the unit direction in which TexturePlace::along grows,
/// perpendicular to the normal, and the sign (±1) of normal × tangent in which `around` grows. Tangents require
/// `textured` surfaces.
struct SurfaceRequest {
  Entity person;
  std::span<const SurfaceMuscle> muscles;  // all that drive the surfaces; others are ignored
  const BodySurfaces* surfaces = nullptr;
  VertexStream positions{}, normals{};
  Vec3<float> origin_m{0, 0, 0};
  const SurfaceFit* fit = nullptr;  // for surfaces bound to another body; null: bound to a similar one
  VertexStream tangents{{}, 4 * sizeof(float)};
  /// Instant after the last tick, 0 to 0.2 s, as in PoseWriter: a frame's alpha times the tick. Bones and lines of
  /// action are exact there. Bellies keep the shape of the tick and lengthen with their lines.
  double ahead_s = 0;
};

/// Writes the vertices of bones and muscles of many people. It keeps its scratch memory, and one thread at a time can
/// use it.
class SurfaceWriter {
 public:
  explicit SurfaceWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes the vertices of each request with `jobs`, in `axes`. The bytes are the same for any number of threads.
  /// Streams of different requests must not overlap, which is not checked. A muscle without control points
  /// (Method::none, or switched off) has its rest shape, stretched to its line of action. Allocates only for more
  /// requests or larger surfaces than in any earlier call. Errors, with the index of the request and before anything is
  /// written: a stale person or muscle; a person without a pose (Status::missing: compact or asleep); a driving muscle
  /// that is not in the list, belongs to another person, or has other cells than the bound surfaces; a time out of
  /// range; a stride or a buffer that is too small; streams of one request that overlap; tangents without normals or
  /// textured surfaces.
  Result<void> write(const World& world, std::span<const SurfaceRequest> requests, const Jobs& jobs = {},
                     const VertexAxes& axes = {});

 private:
  /// A row of a component: its words, `stride` floats apart.
  struct Row {
    const float* word = nullptr;
    std::size_t stride = lane_count;
  };
  struct Line {
    Row line, pull, scale;        // LineOfAction; Musculotendon, or null; LegScale
    const float* node = nullptr;  // a lane of control points, or null
    float longer_m = 0;           // since the tick, at a later instant
  };
  struct Resolved {
    Row pose;
    std::size_t first_line = 0;  // two for each driver
  };
  struct Work;

  Result<void> resolve(const World& world, const SurfaceRequest& request);
  static void look_ahead(void* work, std::size_t begin, std::size_t end);
  static void write_pieces(void* work, std::size_t begin, std::size_t end);

  std::pmr::vector<Resolved> person_;
  std::pmr::vector<Line> line_;
  std::pmr::vector<Pose<float>> later_pose_;          // of each request at a later instant
  std::pmr::vector<LineOfAction<float>> later_line_;  // of each line
  ScratchPool scratch_;
};

}  // namespace mobil::inline v0_3
