// Skin and clothes as triangles in the host's buffers.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
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

/// A stream of the caller's; without bytes where it is left out.
int skin_stream(Line& line, void* memory, std::size_t stride, std::size_t bytes, const char* name, VertexStream& to) {
  to.stride = stride == 0 ? 3 * sizeof(float) : stride;
  if (memory == nullptr) return MOBIL_OK;
  if (bytes == 0)
    return line.refuse(MOBIL_ROOM, fmt::format("{} in 0 bytes; say how many there are, or leave them null", name));
  to.bytes = {static_cast<std::byte*>(memory), bytes};
  return MOBIL_OK;
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
  const auto pose = s.world().get<Pose>(to.person);
  if (!pose) return s.line.refuse(pose.error());
  posed.pose = *pose;
  to.pose = &posed.pose;
  if (const int code =
          skin_stream(s.line, as.positions, as.position_stride, as.position_bytes, "positions", to.positions))
    return code;
  if (const int code = skin_stream(s.line, as.normals, as.normal_stride, as.normal_bytes, "normals", to.normals))
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

/// A stream that was written, in the host's axes.
template <class F>
void turn_stream(const VertexStream& stream, std::size_t vertices, const F& convert) {
  if (stream.bytes.empty()) return;
  for (std::size_t v = 0; v < vertices; ++v) {
    float value[3];
    std::byte* const at = stream.bytes.data() + v * stream.stride;
    std::memcpy(value, at, sizeof value);
    convert(value);
    std::memcpy(at, value, sizeof value);
  }
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
    for (std::size_t i = 0; i < index.size(); ++i) {
      const std::size_t corner = i % 3;  // of mirrored axes the second and the third change places
      out[i] = index[s.axes.mirrored() && corner != 0 ? i + 3 - 2 * corner : i];
    }
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
        turn_stream(request.positions, vertices, [&](float* v) { s.axes.place_to({v[0], v[1], v[2]}, v); });
        turn_stream(request.normals, vertices, [&](float* v) { s.axes.direction_to({v[0], v[1], v[2]}, v); });
      }
    });
    return int{MOBIL_OK};
  });
}
