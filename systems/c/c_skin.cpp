// Skin and clothes as triangles in the host's buffers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <vector>

#include "systems/c/c_call.h"
#include "systems/people/person.h"
#include "systems/surfaces/skin_writer.h"

namespace {

using namespace mobil;
using namespace mobil::c;

/// Null for none such, and where there is no memory for it.
const SkinMesh* mesh_of(int sex, int detail) noexcept try {
  if (sex < 0 || sex > static_cast<int>(Sex::woman) || detail < 0 || detail >= static_cast<int>(skin_details))
    return nullptr;
  return &skin_mesh(static_cast<Sex>(sex), static_cast<SkinDetail>(detail));
} catch (const std::bad_alloc&) {
  return nullptr;
}

/// A person's pose, and muscles' vertices in our axes, from the world's origin.
struct Posed {
  Pose<float> pose;
  std::array<std::vector<Vec3<float>>, 2> of_side;
};

int request_of(mobil_sim& s, const mobil_skin_target& as, Posed& posed, SkinRequest& to) {
  to.person = entity_of(as.id);
  if (!s.world().is_person(to.person)) return s.line.refuse(Error{{}, Status::stale_entity});
  SkinDetail detail{};
  if (const int code = one_of(s.line, as.detail, SkinDetail::distant, "detail", detail)) return code;
  if (as.positions == nullptr) return s.line.refuse_null("positions");
  const BodyRequest body = body_request(s.world().world(), to.person);
  if (as.sex >= 0 && as.sex != static_cast<int>(body.sex))
    return s.line.refuse(MOBIL_REFUSED, "the person is of the other sex, whose triangles are others");
  const auto shape = s.skins.of(body, detail);
  if (!shape) return s.line.refuse(shape.error());
  to.shape = *shape;
  if (as.flexing != 0) {
    const auto table = s.skin_tables.of(body);
    if (!table) return s.line.refuse(table.error());
    to.table = *table;
  }
  const auto pose = s.world().get<Pose>(to.person);
  if (!pose) return s.line.refuse(pose.error());
  posed.pose = *pose;
  to.pose = &posed.pose;
  constexpr std::size_t three = 3 * sizeof(float);
  if (const int code =
          stream_of(s.line, as.positions, as.position_stride, as.position_bytes, three, "positions", to.positions))
    return code;
  if (const int code = stream_of(s.line, as.normals, as.normal_stride, as.normal_bytes, three, "normals", to.normals))
    return code;
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

}  // namespace

size_t mobil_skin_vertex_count(int sex, int detail) {
  const SkinMesh* const mesh = mesh_of(sex, detail);
  return mesh == nullptr ? 0 : mesh->vertex.size();
}

size_t mobil_skin_index_count(int sex, int detail) {
  const SkinMesh* const mesh = mesh_of(sex, detail);
  return mesh == nullptr ? 0 : mesh->triangle.size();
}

int mobil_skin_indices(mobil_sim* sim, int sex, int detail, unsigned int* out, size_t room, unsigned int* first) {
  static_assert(skin_parts == MOBIL_SKIN_PARTS);
  return call(sim, "mobil_skin_indices", [&](mobil_sim& s) {
    const SkinMesh* const mesh = mesh_of(sex, detail);
    if (mesh == nullptr) {
      return s.line.refuse(MOBIL_REFUSED,
                           fmt::format("sex {}, detail {}; choose 0 or 1, and 0 to {}", sex, detail, skin_details - 1));
    }
    if (out == nullptr) return s.line.refuse_null("out");
    const auto& index = mesh->triangle;
    if (room < index.size())
      return s.line.refuse(MOBIL_ROOM, fmt::format("room for {} indices; {} are needed", room, index.size()));
    wind(index, s.axes.mirrored(), out);
    if (first != nullptr) std::copy(mesh->first_triangle.begin(), mesh->first_triangle.end(), first);
    return int{MOBIL_OK};
  });
}

int mobil_write_skin(mobil_sim* sim, const mobil_skin_target* targets, size_t stride, size_t count) {
  return call(sim, "mobil_write_skin", [&](mobil_sim& s) {
    if (const int code = struct_stride(s.line, targets, count, "targets", stride)) return code;
    std::vector<Posed> posed(count);
    std::vector<SkinRequest> requests(count);
    for (std::size_t i = 0; i < count; ++i) {
      mobil_skin_target as;
      if (const int code = read_struct(s.line, row_at(targets, i, stride, 0), "targets", as)) return code;
      if (const int code = request_of(s, as, posed[i], requests[i])) return code;
    }
    const auto done = s.skin_writer.write(s.world().world(), requests, s.jobs_of());
    if (!done) return s.line.refuse(done.error());
    if (s.axes.ours()) return int{MOBIL_OK};
    in_parallel(s.jobs_of(), count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const SkinRequest& request = requests[i];
        const std::size_t vertices = request.shape.skin->rest.size();
        turn_vertices(request.positions, 0, vertices, 3, [&](float* v) { s.axes.place_to({v[0], v[1], v[2]}, v); });
        turn_vertices(request.normals, 0, vertices, 3, [&](float* v) { s.axes.direction_to({v[0], v[1], v[2]}, v); });
      }
    });
    return int{MOBIL_OK};
  });
}
