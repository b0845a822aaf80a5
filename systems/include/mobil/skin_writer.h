#pragma once
// People's skin as vertices: positions and unit normals into the caller's buffers.
//
//   BodySkins skins;                                             // keeps what many share
//   const SkinShape shape = *skins.of(body, SkinDetail::near);   // each person, once
//   SkinWriter writer;
//   SkinRequest one{person, shape, {buffer, 24}, {buffer.subspan(12), 24}};
//   writer.write(simulation.world(), {&one, 1}, jobs);           // each frame
//
// Triangles are skin_mesh(sex, detail)'s (mobil/assets/surfaces/body_skin.h), the same for all men and for all women.

#include <array>
#include <map>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <tuple>

#include <mobil/assets/surfaces/body_skin.h>
#include <mobil/engine/error.h>
#include <mobil/engine/jobs.h>
#include <mobil/engine/scratch.h>
#include <mobil/engine/world.h>
#include <mobil/systems/surfaces/cover_muscles.h>
#include <mobil/systems/surfaces/skin_table.h>
#include <mobil/systems/surfaces/vertex_stream.h>

namespace mobil::inline v0_3 {

/// A skin, and by how much a person is taller than the body that it was made for.
struct SkinShape {
  const BodySkin* skin = nullptr;
  float lengths = 1;
};

/// Skins that people of about one build share.
class BodySkins {
 public:
  explicit BodySkins(const SkinDress& dress = {}) : dress_(dress) {}

  /// A skin for a body: made for its sex and a body mass index near its own, and as much larger as it is taller. Near
  /// by that is within 0.75 kg/m² (1.5 % of its girths), from afar within 1.5, between 13.5 and 64.5 kg/m²; beyond, as
  /// there. Limbs of their own are not followed: what they are longer by is drawn out at the joints. A quarter of a
  /// second for the first of a build, half a second in full detail. Good as long as this lives. Errors: as make_body.
  /// Not for several threads at once.
  Result<SkinShape> of(const BodyRequest& body, SkinDetail detail);

 private:
  SkinDress dress_;
  std::map<std::pair<Sex, int>, std::optional<form::TrunkFit>> fit_;  // by kg/m² in steps
  std::map<std::tuple<Sex, SkinDetail, int>, std::unique_ptr<BodySkin>> skin_;
};

/// One person with a skin, whose fat wobbles where they have the effect (Feature::fat) and are awake and
/// whole. Positions in m, world axes, from `origin_m`, as of SurfaceRequest; normals may be left out.
struct SkinRequest {
  Entity person;
  SkinShape shape;
  VertexStream positions{}, normals{};
  Vec3<float> origin_m{0, 0, 0};
  /// The vertices of each leg's muscles, by Side, in the world whatever `origin_m` is, as a SurfaceWriter wrote them;
  /// none: the leg is as `table` says. A tenth of them serves (SurfaceChoice::detail); SurfaceChoice::sides binds each
  /// side by itself.
  std::array<std::span<const Vec3<float>>, 2> muscles{};
  /// Legs without vertices of muscles move as if they had some. Of the person's sex and build (SkinTables::of); good
  /// until `write` returns. Null: they do not.
  const SkinTable* table = nullptr;
  const Pose<float>* pose = nullptr;  // Simulation::get<Pose> of who is compact or asleep; null: that on their row
};

class SkinWriter {
 public:
  explicit SkinWriter(std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  /// Writes each request's vertices, as they are after the last tick, with `jobs`; the same bytes for any number of
  /// threads. Streams of different requests must not lie over each other, which is not looked at. Errors, in one line
  /// that names the request, before anything is written: a stale person, one without a pose on their row where none is
  /// given (Status::missing), no skin, a stride or a buffer that is too small.
  Result<void> write(const World& world, std::span<const SkinRequest> requests, const Jobs& jobs = {});

 private:
  struct Work;
  static void write_people(void* work, std::size_t begin, std::size_t end);

  ScratchPool scratch_;
};

}  // namespace mobil::inline v0_3
