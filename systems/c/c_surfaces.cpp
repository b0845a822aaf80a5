// Bones and muscles as triangles in the host's buffers.

#include "systems/c/c_surfaces.h"

#include <cstring>
#include <span>

#include <mobil/systems/muscles/person.h>

namespace {

using namespace mobil;
using namespace mobil::c;

struct Target {
  mobil_surface_target as;
  std::vector<SurfaceMuscle> muscles;
  SurfaceFit fit;
};

int request_of(mobil_sim& s, Target& target, SurfaceRequest& to) {
  const mobil_surface_target& as = target.as;
  if (as.surfaces == nullptr) return s.line.refuse_null("surfaces");
  if (as.positions == nullptr) return s.line.refuse_null("positions");
  const Entity person = entity_of(as.id);
  const auto subject = s.world().person(person);
  if (!subject) return s.line.refuse(Error{{}, Status::stale_entity});
  for (const PersonMuscle& own : subject->muscles) target.muscles.push_back({own.plan.muscle, own.entity});
  target.fit = fit_surfaces(as.surfaces->bound, subject->body);
  to.person = person;
  to.muscles = target.muscles;
  to.surfaces = &as.surfaces->bound;
  to.fit = &target.fit;
  to.origin_m = s.axes.place_from(as.origin);
  to.ahead_s = as.ahead_s;
  constexpr std::size_t three = 3 * sizeof(float), four = 4 * sizeof(float);
  if (const int code =
          stream_of(s.line, as.positions, as.position_stride, as.position_bytes, three, "positions", to.positions))
    return code;
  if (const int code = stream_of(s.line, as.normals, as.normal_stride, as.normal_bytes, three, "normals", to.normals))
    return code;
  return stream_of(s.line, as.tangents, as.tangent_stride, as.tangent_bytes, four, "tangents", to.tangents);
}

}  // namespace

int mobil_bind_surfaces(mobil_sim* sim, mobil_id like, const mobil_surface_choice* choice, mobil_surfaces** out) {
  return call(sim, "mobil_bind_surfaces", [&](mobil_sim& s) {
    if (out == nullptr) return s.line.refuse_null("out");
    *out = nullptr;
    mobil_surface_choice known;
    if (const int code = read_struct(s.line, choice, "choice", known)) return code;
    if (known.side < MOBIL_RIGHT || known.side > MOBIL_BOTH)
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("side {}; choose MOBIL_RIGHT, MOBIL_LEFT or MOBIL_BOTH", known.side));
    SurfaceChoice as;
    as.bones = known.bones != 0;
    as.sides = {known.side != MOBIL_LEFT, known.side != MOBIL_RIGHT};
    if (const int code = muscle_set(s.line, known.muscles, known.more_muscles, as.simulated)) return code;
    as.cells = {known.cells[0], known.cells[1], known.cells[2]};
    as.detail = known.detail;
    as.textured = known.textured != 0;
    const auto subject = s.world().person(entity_of(like));
    if (!subject) return s.line.refuse(Error{{}, Status::stale_entity});
    auto bound = bind_surfaces(subject->body, as);
    if (!bound) return s.line.refuse(bound.error());
    *out = new mobil_surfaces{std::move(*bound), as.simulated, as.cells, s.axes.mirrored()};
    return int{MOBIL_OK};
  });
}

void mobil_drop_surfaces(mobil_surfaces* surfaces) {
  delete surfaces;
}

size_t mobil_vertex_count(const mobil_surfaces* surfaces) {
  return surfaces == nullptr ? 0 : surfaces->bound.vertices;
}

size_t mobil_index_count(const mobil_surfaces* surfaces) {
  return surfaces == nullptr ? 0 : surfaces->bound.index.size();
}

int mobil_indices(const mobil_surfaces* surfaces, unsigned int* out, size_t room) {
  if (surfaces == nullptr || out == nullptr) return MOBIL_REFUSED;
  const auto& index = surfaces->bound.index;
  if (room < index.size()) return MOBIL_ROOM;
  wind(index, surfaces->mirrored, out);
  return MOBIL_OK;
}

int mobil_texture_places(const mobil_surfaces* surfaces, float* out, size_t room) {
  if (surfaces == nullptr || out == nullptr) return MOBIL_REFUSED;
  const auto& texture = surfaces->bound.texture;
  if (texture.empty()) return MOBIL_MISSING;
  if (room < 2 * texture.size()) return MOBIL_ROOM;
  for (const TexturePlace& place : texture) {
    *out++ = place.along;
    *out++ = place.around;
  }
  return MOBIL_OK;
}

int mobil_surface_tissue(const mobil_surfaces* surfaces, unsigned char* out, size_t room) {
  if (surfaces == nullptr || out == nullptr) return MOBIL_REFUSED;
  const auto tissue = std::as_bytes(std::span(surfaces->bound.tissue));
  if (room < tissue.size()) return MOBIL_ROOM;
  std::memcpy(out, tissue.data(), tissue.size());
  return MOBIL_OK;
}

int mobil_surface_part(const mobil_surfaces* surfaces, int part, mobil_part* out) {
  if (surfaces == nullptr || out == nullptr) return MOBIL_REFUSED;
  const auto at = static_cast<std::size_t>(part);
  if (part < 0 || at >= surfaces->bound.part.size()) return MOBIL_MISSING;
  const SurfacePart& p = surfaces->bound.part[at];
  *out = {p.name.c_str(),
          p.driver ? -1 : static_cast<int>(p.segment),
          p.driver ? static_cast<int>(*p.driver) : -1,
          static_cast<int>(p.side),
          p.first_vertex,
          p.vertices,
          p.first_index,
          p.indices};
  return MOBIL_OK;
}

int mobil_write_surfaces(mobil_sim* sim, const mobil_surface_target* targets, size_t stride, size_t count) {
  return call(sim, "mobil_write_surfaces", [&](mobil_sim& s) {
    if (const int code = struct_stride(s.line, targets, count, "targets", stride)) return code;
    std::vector<Target> all(count);
    std::vector<SurfaceRequest> requests(count);
    for (std::size_t i = 0; i < count; ++i) {
      if (const int code = read_struct(s.line, row_at(targets, i, stride, 0), "targets", all[i].as)) return code;
      if (const int code = request_of(s, all[i], requests[i])) return code;
      if (const int code = same_handedness(s, all[i].as.surfaces->mirrored)) return code;
    }
    return code_of(s.line, s.surfaces->write(s.world().world(), requests, s.jobs, s.axes));
  });
}
