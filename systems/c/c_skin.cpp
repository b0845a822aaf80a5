// Skin and clothes as triangles in the host's buffers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include "systems/c/c_skin.h"
#include "systems/people/person_requests.h"

namespace {

using namespace mobil;
using namespace mobil::c;

int request_of(mobil_sim& s, const mobil_skin_target& as, PosedSkin& posed, SkinRequest& to) {
  SkinDetail detail{};
  if (const int code = one_of(s.line, as.detail, SkinDetail::distant, "detail", detail)) return code;
  if (const int code = skin_person(s, as, as.sex, posed, to)) return code;
  const auto shape = s.skins.of(body_request(s.world().world(), to.person), detail);
  if (!shape) return s.line.refuse(shape.error());
  to.shape = *shape;
  return skin_streams(s, as, to.positions, to.normals);
}

}  // namespace

int mobil::c::skin_streams(mobil_sim& s, const mobil_skin_target& as, VertexStream& positions, VertexStream& normals) {
  if (as.positions == nullptr) return s.line.refuse_null("positions");
  constexpr std::size_t three = 3 * sizeof(float);
  if (const int code =
          stream_of(s.line, as.positions, as.position_stride, as.position_bytes, three, "positions", positions))
    return code;
  return stream_of(s.line, as.normals, as.normal_stride, as.normal_bytes, three, "normals", normals);
}

int mobil::c::same_sex(mobil_sim& s, int sex, const BodyRequest& body) {
  if (sex < 0 || sex == static_cast<int>(body.sex)) return MOBIL_OK;
  return s.line.refuse(MOBIL_REFUSED, "the person is of the other sex, whose triangles are others");
}

int mobil::c::skin_person(mobil_sim& s, const mobil_skin_target& as, int sex, PosedSkin& posed, SkinRequest& to) {
  to.person = entity_of(as.id);
  if (!s.world().is_person(to.person)) return s.line.refuse(Error{{}, Status::stale_entity});
  const BodyRequest body = body_request(s.world().world(), to.person);
  if (const int code = same_sex(s, sex, body)) return code;
  if (as.flexing != 0) {
    const auto table = s.skin_tables.of(body);
    if (!table) return s.line.refuse(table.error());
    to.table = *table;
  }
  to.ahead_s = as.ahead_s;
  if (s.world().state(to.person) == PersonState::asleep) {
    posed.pose = *s.world().get<Pose>(to.person);
    to.pose = &posed.pose;
  }
  to.origin_m = s.axes.place_from(as.origin);
  for (std::size_t side = 0; side < 2; ++side) {
    if (as.muscles[side] == nullptr) continue;
    posed.of_side[side].reserve(as.muscle_vertices[side]);
    for (std::size_t v = 0; v < as.muscle_vertices[side]; ++v) {
      const Vec3<float> at = s.axes.place_from(as.muscles[side] + 3 * v);
      posed.of_side[side].push_back({at.x + to.origin_m.x, at.y + to.origin_m.y, at.z + to.origin_m.z});
    }
    to.muscles[side] = posed.of_side[side];
  }
  return MOBIL_OK;
}

size_t mobil_skin_vertex_count(int sex, int detail) {
  return skin_count(sex, detail, [](Sex of, SkinDetail at) { return skin_mesh(of, at).vertex.size(); });
}

size_t mobil_skin_index_count(int sex, int detail) {
  return skin_count(sex, detail, [](Sex of, SkinDetail at) { return skin_mesh(of, at).triangle.size(); });
}

int mobil_skin_indices(mobil_sim* sim, int sex, int detail, unsigned int* out, size_t room, unsigned int* first) {
  static_assert(skin_parts == MOBIL_SKIN_PARTS);
  return call(sim, "mobil_skin_indices", [&](mobil_sim& s) {
    if (!is_skin(sex, detail)) {
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("sex {}, detail {}; choose 0 or 1, and 0 to {}", sex, detail, skin_details - 1));
    }
    if (out == nullptr) return s.line.refuse_null("out");
    const SkinMesh& mesh = skin_mesh(static_cast<Sex>(sex), static_cast<SkinDetail>(detail));
    const auto& index = mesh.triangle;
    if (room < index.size())
      return s.line.refuse(MOBIL_ROOM, fmt::format("room for {} indices; {} are needed", room, index.size()));
    wind(index, s.axes.mirrored(), out);
    if (first != nullptr) std::copy(mesh.first_triangle.begin(), mesh.first_triangle.end(), first);
    return int{MOBIL_OK};
  });
}

int mobil_write_skin(mobil_sim* sim, const mobil_skin_target* targets, size_t stride, size_t count) {
  return call(sim, "mobil_write_skin", [&](mobil_sim& s) {
    if (const int code = struct_stride(s.line, targets, count, "targets", stride)) return code;
    std::vector<PosedSkin> posed(count);
    std::vector<SkinRequest> requests(count);
    std::vector<std::array<Vec3<float>, 2>> boxes(count);
    std::vector<float*> bounds(count);
    for (std::size_t i = 0; i < count; ++i) {
      mobil_skin_target as;
      if (const int code = read_struct(s.line, row_at(targets, i, stride, 0), "targets", as)) return code;
      if (const int code = request_of(s, as, posed[i], requests[i])) return code;
      if (as.bounds == nullptr) continue;
      bounds[i] = as.bounds;
      requests[i].bounds = &boxes[i];
    }
    const auto done = s.skin_writer.write(s.world().world(), requests, s.jobs, s.axes);
    for (std::size_t i = 0; done && i < count; ++i)
      if (bounds[i] != nullptr) std::memcpy(bounds[i], boxes[i].data(), sizeof boxes[i]);
    return code_of(s.line, done);
  });
}
