#pragma once
// Writes people's skin as vertices: positions and unit normals into the caller's buffers.
//
//   BodySkins skins;                                             // stores shared skins
//   const SkinShape shape = *skins.of(body, SkinDetail::near);   // once for each person
//   SkinWriter writer;
//   SkinRequest one{person, shape, {buffer, 24}, {buffer.subspan(12), 24}};
//   writer.write(simulation.world(), {&one, 1}, jobs);           // each frame
//
// The triangles are those of skin_mesh(sex, detail) (mobil/assets/surfaces/body_skin.h), one set for each sex.

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/cover_muscles.h>
#include <mobil/systems/surfaces/skin_table.h>
#include <mobil/systems/surfaces/vertex_stream.h>

namespace mobil::inline v0_3 {

/// A skin, and the ratio of the person's height to that of the skin's body.
struct SkinShape {
  const BodySkin* skin = nullptr;
  float lengths = 1;
};

/// Skins that people of similar build share. Not thread-safe.
class BodySkins {
 public:
  explicit BodySkins(const SkinDress& dress = {}) : dress_(dress) {}

  /// Returns a skin for a body, made for its sex, a similar age (`skin_build`) and a similar body mass index, and
  /// scaled by height. The index is within 0.75 kg/m² (1.5 % of its girths) for near skins and 1.5 for distant ones,
  /// between 13.5 and 64.5 kg/m²; values beyond are clamped. Individual limb lengths are ignored: longer limbs stretch
  /// the skin at the joints. The first skin of a build takes 0.25 s, or 0.5 s in full detail. Valid as long as this
  /// object. Errors: those of make_body.
  Result<SkinShape> of(const BodyRequest& body, SkinDetail detail);

  /// Makes the skins of usual builds, with body mass indices of 17 to 34 kg/m², for both sexes and the details `near`,
  /// `far` and `distant`, in about 10 s. `progress`, if set, is called with the numbers of skins made and of all.
  void prepare(const std::function<void(std::size_t made, std::size_t all)>& progress = {});
  /// Returns the shared meshes and all skins as bytes, for `load`; the finest meshes only with skins of them.
  std::vector<std::byte> bake() const;
  /// Loads the bytes of `bake` in 5 ms, or 50 ms in memory that the process has not used before, so that neither meshes
  /// nor these skins are made at run time. Skins have the same bits with and without it. Errors, and nothing is loaded:
  /// bytes of another version or another processor's arithmetic, of other clothes, cut or altered.
  Result<void> load(std::span<const std::byte> baked);

 private:
  static constexpr float index_step = 1.5F;  // kg/m², between builds with a skin of their own

  SkinDress dress_;
  // By age in years and kg/m² in steps of index_step.
  std::map<std::tuple<Sex, int, int>, std::optional<form::TrunkFit>> fit_;
  std::map<std::tuple<Sex, SkinDetail, int, int>, std::unique_ptr<BodySkin>> skin_;
};

/// One person with a skin. The fat of full people with Feature::fat wobbles. Positions are in m and world axes,
/// relative to `origin_m` as in SurfaceRequest, unless `write` is given other axes. Normals are optional.
struct SkinRequest {
  Entity person;
  SkinShape shape;
  VertexStream positions{}, normals{};
  Vec3<float> origin_m{0, 0, 0};
  /// Vertices of each leg's muscles, by Side, as a SurfaceWriter wrote them, always relative to the world's origin. If
  /// empty, `table` shapes the leg. A detail of 0.1 is enough (SurfaceChoice::detail). SurfaceChoice::sides binds each
  /// side separately.
  std::array<std::span<const Vec3<float>>, 2> muscles{};
  /// Table that shapes legs without vertices of muscles, for the person's sex and build (SkinTables::of). It must stay
  /// valid until `write` returns. Null: those legs have no muscle shape.
  const SkinTable* table = nullptr;
  const Pose<float>* pose = nullptr;  // null: the person's own; sleepers need get<Pose>
  /// Instant after the last tick, 0 to 0.2 s, as in PoseWriter: a frame's alpha times the tick. It has no effect on a
  /// given `pose`. `muscles` must be of the same instant; the fat's displacement is that of the tick.
  double ahead_s = 0;
  /// Receives the minimum and the maximum coordinates of the written positions, for culling, unless null.
  std::array<Vec3<float>, 2>* bounds = nullptr;
};

class SkinWriter {
 public:
  explicit SkinWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes the vertices of each request with `jobs`, in `axes`. The bytes are the same for any number of threads.
  /// Streams of different requests must not overlap, which is not checked. Errors name the request and precede any
  /// writing: a stale handle, a sleeper without a given pose (Status::missing), no skin, a time out of
  /// range, a stride or a buffer that is too small.
  Result<void> write(const World& world, std::span<const SkinRequest> requests, const Jobs& jobs = {},
                     const VertexAxes& axes = {});

 private:
  struct Work;
  static void write_people(void* work, std::size_t begin, std::size_t end);

  ScratchPool scratch_;
};

}  // namespace mobil::inline v0_3
